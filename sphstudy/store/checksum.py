"""Whether a file is what was written: after its end stand a text, and a digest of all bytes before it.

HDF5 has no checksums of attributes and single numbers, and reads what bits have become. It does not mind
bytes after its own, so that any reader of netCDF reads a sealed file. The text says in short what is in
the file: opening a netCDF file and going through its variables takes a hundred times longer.
"""

import hashlib
import os
from pathlib import Path
from typing import Any

SEALED = "sealed"
"""Global attribute of a file that has a seal: one without it is not whole."""

HOW = "a text and a digest follow the file's end"
"""Its value."""

_MARK = b"sphstudy, digest"
_LENGTH = 8
_TAIL = _LENGTH + len(_MARK) + hashlib.sha256().digest_size


def seal(path: Path, text: str) -> None:
    """Puts a text and the digest after the end of a file, and all on the disk. Raises OSError."""
    said = text.encode()
    said += len(said).to_bytes(_LENGTH, "little") + _MARK
    with open(path, "r+b") as file:
        digest = hashlib.file_digest(file, "sha256")
        digest.update(said)
        file.seek(0, os.SEEK_END)
        file.write(said + digest.digest())
        file.flush()
        os.fsync(file.fileno())


def check_seal(path: Path) -> str | None:
    """The text of a sealed file; None if it has no seal. Raises ValueError if it has changed since."""
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END) - _TAIL
        if size < 0:
            return None
        file.seek(size)
        tail = file.read()
        if tail[_LENGTH : _LENGTH + len(_MARK)] != _MARK:
            return None
        length = int.from_bytes(tail[:_LENGTH], "little")
        if length > size:
            raise ValueError(_CHANGED)
        file.seek(0)
        digest, left = hashlib.sha256(), size - length
        while left > 0 and (part := file.read(min(left, 1 << 20))):
            digest.update(part)
            left -= len(part)
        said = file.read(length)
    digest.update(said + tail[: _LENGTH + len(_MARK)])
    if digest.digest() != tail[_LENGTH + len(_MARK) :]:
        raise ValueError(_CHANGED)
    return said.decode()


_CHANGED = "its bytes are not those that were written"


def taken_seal(attributes: dict[str, Any], sealed: bool) -> None:
    """Takes out of a file's attributes that it is sealed. Raises ValueError if it is not; a file from
    before there were seals passes.
    """
    if attributes.pop(SEALED, None) == HOW and not sealed:
        raise ValueError("cut off, or written by another program")
