"""Where numbers come from: versions, state of the sources, processor."""

import base64
import hashlib
import os
import platform
import subprocess
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, PackagePath, distribution, version
from pathlib import Path

_LIBRARIES = ("numpy", "numba", "llvmlite", "scipy", "xarray", "netCDF4", "hydra-core")

_SOURCES = ("sphstudy", "conf")
"""What a run is made of, in a checkout: files there that git does not know count as changes."""


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
        return _installed()
    try:
        commit = _git(root, "rev-parse", "HEAD")
        dirty = _git(root, "status", "--porcelain", "--untracked-files=all", "--", *_SOURCES)
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return f"{commit} (dirty)" if dirty else commit


def _installed() -> str:
    """Whether the files of an installed package are those that were installed."""
    try:
        files = distribution("sphstudy").files or []
        edited = [f for f in files if f.suffix in (".py", ".yaml", ".toml") and _differs(f)]
    except (PackageNotFoundError, OSError):
        return "not a git checkout"
    return "installed" if not edited else f"installed, {len(edited)} files edited since"


def _differs(file: PackagePath) -> bool:
    if file.hash is None:
        return False
    digest = hashlib.sha256(file.read_binary()).digest()
    return base64.urlsafe_b64encode(digest).decode().rstrip("=") != file.hash.value


def _git(root: Path, *arguments: str) -> str:
    command = ["git", "-C", str(root), *arguments]
    done = subprocess.run(command, capture_output=True, check=True, timeout=10)
    return done.stdout.decode(errors="replace").strip()


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text("utf-8", "replace").splitlines():
            if line.startswith("model name"):
                return f"{line.partition(':')[2].strip()}, {os.cpu_count()} logical cores"
    except OSError:
        pass
    return platform.processor() or "unknown"
