"""Whether a file is what was written: a digest of all its bytes, after their end.

HDF5 has no checksums of attributes and single numbers, and reads what bits have become. It does not mind
bytes after its own, so that any reader of netCDF reads a sealed file.
"""

import hashlib
import os
from pathlib import Path

_MARK = b"sphstudy, sha256"
_SIZE = len(_MARK) + hashlib.sha256().digest_size


def seal(path: Path) -> None:
    """Puts the digest after the end of a file, and both on the disk. Raises OSError."""
    with open(path, "r+b") as file:
        digest = hashlib.file_digest(file, "sha256").digest()
        file.seek(0, os.SEEK_END)
        file.write(_MARK + digest)
        file.flush()
        os.fsync(file.fileno())


def check_seal(path: Path) -> None:
    """Raises ValueError if a sealed file has changed. One without a seal, from before, passes: what is
    cut off at its end HDF5 notices itself.
    """
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END) - _SIZE
        if size < 0:
            return
        file.seek(size)
        tail = file.read()
        mark, expected = tail[: len(_MARK)], tail[len(_MARK) :]
        # A seal whose own mark is damaged is one all the same.
        if sum(a == b for a, b in zip(mark, _MARK, strict=True)) < len(_MARK) // 2:
            return
        file.seek(0)
        digest = hashlib.sha256()
        while size > 0 and (part := file.read(min(size, 1 << 20))):
            digest.update(part)
            size -= len(part)
    if mark != _MARK or digest.digest() != expected:
        raise ValueError("its bytes are not those that were written")
