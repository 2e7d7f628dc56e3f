"""Writing a file so that its place holds either the old file or the whole new one."""

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

UNFINISHED = ".writing-"
"""How the names of files begin that are being written."""


@contextmanager
def replacing(path: Path, durable: bool = True) -> Iterator[Path]:
    """A context in which a new file is written beside `path`; at its end the file gets that name.

    Parameters
    ----------
    path : Path
        Where the file goes; its folder is made if need be.
    durable : bool
        Whether the file is on the disk before it gets its name: a machine that loses power then has the
        old file or the new one, not an empty one.

    Yields
    ------
    Path
        The empty file to write to. An exception removes it, and leaves the old one.

    Raises
    ------
    OSError
        If the disk does not take it.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{UNFINISHED}{uuid.uuid4().hex}")
    # Not by tempfile, whose files are their owner's alone: who may read results, umask says.
    temporary.open("xb").close()
    try:
        yield temporary
        if durable:
            with open(temporary, "rb") as file:
                os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
