"""Whether a file is what was written: after its end stand a text, and a digest of all bytes before it.

HDF5 has no checksums of attributes and single numbers and does not notice a changed bit there. It ignores
bytes after its own: any reader of netCDF reads a sealed file. The text is a summary of the file: opening
netCDF and going through its variables takes a hundred times longer than reading it. It has a checksum of
its own, so that it can be trusted without reading the whole file:

    netCDF file | text | CRC-32 of text and file size | length of the text (8 bytes) | mark | SHA-256
"""

import hashlib
import os
import stat
import zlib
from pathlib import Path
from typing import Any

SEALED = "sealed"
"""Global attribute of a file that was written with a seal: without the seal, it has been cut off."""

HOW = "a text and a digest follow the file's end"
"""Value of that attribute."""

_MARK = b"sphstudy, sealed"
_WITHOUT_OWN = b"sphstudy, digest"
"""Mark of earlier versions, whose texts have no checksum of their own."""

_DIGEST = hashlib.sha256().digest_size
_FOOT = 8 + len(_MARK) + _DIGEST
_CRC = 4
_AT_ONCE = 1 << 14
"""Bytes at the end of a file that are read first: more than foot and text of nearly all records."""

_CHANGED = "its bytes are not those that were written"


def open_file(path: Path) -> int:
    """A file opened for reading, as a descriptor.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    OSError
        If it cannot be opened.
    ValueError
        If it is a folder, a pipe or a device: to read from a pipe is to wait for whoever writes to it.
    """
    # A pipe is opened without waiting; a file does not care.
    file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    if not stat.S_ISREG(os.fstat(file).st_mode):
        os.close(file)
        raise ValueError("no file, but a folder, a pipe or a device")
    return file


def seal(path: Path, text: str) -> None:
    """Appends a text and the digest to a file.

    Parameters
    ----------
    path : Path
        The file, without a seal.
    text : str
        Its summary.
    """
    summary = text.encode()
    with open(path, "r+b") as file:
        whole = hashlib.file_digest(file, "sha256")
        size = file.seek(0, os.SEEK_END) + len(summary) + _CRC + _FOOT
        end = summary + _checksum(summary, size) + len(summary).to_bytes(8, "little") + _MARK
        whole.update(end)
        file.write(end + whole.digest())


def check_seal(path: Path) -> bool:
    """Reads all bytes of a file.

    Returns
    -------
    bool
        Whether the file has a seal.

    Raises
    ------
    ValueError
        If a byte has changed since the file was sealed.
    """
    with open(open_file(path), "rb") as file:
        left = file.seek(0, os.SEEK_END) - _DIGEST
        file.seek(max(0, left - len(_MARK)))
        if file.read(len(_MARK)) not in (_MARK, _WITHOUT_OWN):
            return False
        expected = file.read()
        file.seek(0)
        digest = hashlib.sha256()
        while left > 0 and (part := file.read(min(left, 1 << 20))):
            digest.update(part)
            left -= len(part)
    if digest.digest() != expected:
        raise ValueError(_CHANGED)
    return True


def sealed_text(path: Path) -> str | None:
    """Reads the end of a file only; all of it if an earlier version sealed it.

    Returns
    -------
    str or None
        The text behind the file; None if it has no seal.

    Raises
    ------
    ValueError
        If the text or the size of the file has changed since the file was sealed.
    """
    # Twenty thousand records are looked at in a row: no more calls than it takes.
    file = open_file(path)
    try:
        size = os.fstat(file).st_size
        end = os.pread(file, _AT_ONCE, max(0, size - _AT_ONCE))
        mark = end[8 - _FOOT : -_DIGEST]
        if mark == _WITHOUT_OWN:
            check_seal(path)
        elif mark != _MARK:
            return None
        own = _CRC if mark == _MARK else 0
        length = int.from_bytes(end[-_FOOT : 8 - _FOOT], "little")
        needed = length + own + _FOOT
        if needed > size:
            raise ValueError(_CHANGED)
        if needed > len(end):
            end = os.pread(file, needed, size - needed)
    finally:
        os.close(file)
    text = end[len(end) - needed : len(end) - needed + length]
    if own and _checksum(text, size) != end[-_FOOT - own : -_FOOT]:
        raise ValueError(_CHANGED)
    return text.decode()


def _checksum(text: bytes, size: int) -> bytes:
    return zlib.crc32(text, size).to_bytes(_CRC, "little")


def remove_marker(attributes: dict[str, Any], sealed: bool) -> None:
    """Removes the attribute `sealed` from a file's attributes.

    Parameters
    ----------
    attributes : dict
        Global attributes of the file.
    sealed : bool
        Whether the file has a seal.

    Raises
    ------
    ValueError
        If the attribute is there and the seal is not. Files that never had either pass.
    """
    if attributes.pop(SEALED, None) == HOW and not sealed:
        raise ValueError("cut off, or written by another program")
