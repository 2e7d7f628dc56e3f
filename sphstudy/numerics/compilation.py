"""How numerical code is compiled: one decorator, one cache keyed on the package's sources.

Numba's own cache does not notice when a function called from *another* file changes. So the cache
folder carries a hash of the sources of all compiled code: after a change it is simply another one.
"""

import errno
import hashlib
import os
import shutil
import stat
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba

_PACKAGE = Path(__file__).parent.parent

# Loops over many arrays need more run-time alias checks than LLVM's defaults admit; without these
# the pair loops are not vectorised at all.
_LLVM_OPTIONS = ("-runtime-memory-check-threshold=256", "-vectorize-memory-check-threshold=512")


def source_hash() -> str:
    """Hash of the sources of the rooms that have compiled code, 16 hexadecimal digits."""
    digest = hashlib.sha256()
    paths = (path for room in ("model", "numerics") for path in (_PACKAGE / room).rglob("*.py"))
    for path in sorted(paths):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    fallback = Path(tempfile.gettempdir()) / f"sphstudy-cache-{os.getuid()}"
    for root in (Path(base) / "sphstudy", fallback):
        folder = root / source_hash()
        try:
            if root == fallback:
                _make_private(root)
            folder.mkdir(parents=True, exist_ok=True)
            os.utime(folder)
        except OSError:
            continue
        if os.access(folder, os.W_OK):
            _forget_old_ones(root)
            return folder
    raise PermissionError(
        errno.EACCES,
        f"set NUMBA_CACHE_DIR: no place for compiled code in {base}, nor {fallback}",
    )


def _make_private(root: Path) -> None:
    """Makes a folder in a place that all users share. Compiled code is pickled, and loading it runs it:
    PermissionError if the folder is not this user's, or if others may write to it.
    """
    with suppress(FileExistsError):
        root.mkdir(mode=0o700)
    found = root.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o022:
        raise PermissionError(errno.EACCES, "not this user's alone", str(root))


def _forget_old_ones(root: Path) -> None:
    """Removes what other versions of the sources left, a month after they were last used."""
    for folder in root.iterdir():
        with suppress(FileNotFoundError):
            if folder.stat().st_mtime < time.time() - 30 * 86400:
                shutil.rmtree(folder, ignore_errors=True)


# Threads of a parallel loop that wait for others sleep: spinning, they would keep the cores of a
# shared machine from those they wait for.
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
if not os.environ.get("NUMBA_CACHE_DIR"):
    numba.config.CACHE_DIR = str(_cache_folder())  # type: ignore[attr-defined]
for _option in _LLVM_OPTIONS:
    llvmlite.binding.set_option("sphstudy", _option)

# IEEE arithmetic, nothing rearranged: into whichever caller a function is compiled, from the cache or
# not, for one thread or several, for wide vectors or narrow ones, it computes the same bits. Inlined,
# which gains more time than rearrangement did.
_OPTIONS: dict[str, Any] = {"cache": True, "error_model": "numpy", "forceinline": True}
# Without the wrappers through which Python would call it, a function compiles in half the time.
_INNER: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}

compiled = numba.njit(**_OPTIONS)
"""Decorator for functions that Python calls."""

compiled_inner = numba.njit(**_OPTIONS, **_INNER)
"""The same for functions that only compiled functions call."""

compiled_parallel = numba.njit(**_OPTIONS, **_INNER, parallel=True)
"""The same for loops over blocks that several threads share (numba.prange)."""
