"""Where numbers come from: versions, state of the sources, processor."""

import os
import platform
import subprocess
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_LIBRARIES = ("numpy", "numba", "llvmlite", "scipy", "xarray", "netCDF4", "hydra-core")


@lru_cache
def provenance() -> dict[str, str]:
    """Attributes for a record: product, Python and library versions, git state, processor."""
    return {
        "sphstudy_version": _version("sphstudy"),
        "python_version": platform.python_version(),
        "library_versions": ", ".join(f"{name} {_version(name)}" for name in _LIBRARIES),
        "git_state": _git_state(),
        "processor": _processor(),
        "operating_system": platform.platform(),
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "unknown"


def _git_state() -> str:
    root = Path(__file__).parent.parent.parent
    if not (root / ".git").exists():
        return "not a git checkout"
    try:
        commit = _git(root, "rev-parse", "HEAD")
        dirty = _git(root, "status", "--porcelain", "--untracked-files=no")
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return f"{commit} (dirty)" if dirty else commit


def _git(root: Path, *arguments: str) -> str:
    command = ["git", "-C", str(root), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=10).stdout.strip()


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return f"{line.partition(':')[2].strip()}, {os.cpu_count()} logical cores"
    except OSError:
        pass
    return platform.processor() or "unknown"
