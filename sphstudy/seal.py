"""Whether a file is what was written: a digest of all its bytes, after their end.

HDF5 has no checksums of attributes and single numbers, and reads what bits have become. It does not mind
bytes after its own, so that any reader of netCDF reads a sealed file.
"""

import hashlib
import os
from pathlib import Path
from typing import Any

SEALED = "sealed"
"""Global attribute of a file that has a seal: one without it is not whole."""

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


def check_seal(path: Path) -> bool:
    """Whether a file has a seal. Raises ValueError if it has changed since."""
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END) - _SIZE
        if size < 0:
            return False
        file.seek(size)
        tail = file.read()
        mark, expected = tail[: len(_MARK)], tail[len(_MARK) :]
        if mark != _MARK:
            return False
        file.seek(0)
        digest = hashlib.sha256()
        while size > 0 and (part := file.read(min(size, 1 << 20))):
            digest.update(part)
            size -= len(part)
    if digest.digest() != expected:
        raise ValueError("its bytes are not those that were written")
    return True


def taken_seal(attributes: dict[str, Any], sealed: bool) -> None:
    """Takes out of a file's attributes that it is sealed. Raises ValueError if it is not; a file from
    before there were seals passes.
    """
    if attributes.pop(SEALED, None) and not sealed:
        raise ValueError("cut off, or written by another program")
