"""What holds for a run besides its solver: a limit of its memory, and a log of what it has to say."""

import contextlib
import os
import platform
import resource
import time
import warnings
from collections.abc import Iterator
from pathlib import Path

GIBIBYTE = 1024**3


@contextlib.contextmanager
def memory_limited(gibibytes: float | None) -> Iterator[None]:
    """Lets the process have so much private writable memory while the block works; whatever asks for more
    gets a MemoryError. By the kernel's limit RLIMIT_DATA (Linux since 4.7).
    """
    if gibibytes is None:
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    wanted = int(gibibytes * GIBIBYTE)
    resource.setrlimit(
        resource.RLIMIT_DATA, (wanted if hard == resource.RLIM_INFINITY else min(wanted, hard), hard)
    )
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))


class Log:
    """A file beside the record of a run that says what became of it, try after try; a disk that is full
    costs lines of it, not the run.
    """

    def __init__(self, path: Path):
        self._path = path

    def say(self, text: str) -> None:
        """Adds lines, the first with date and process."""
        stamp = time.strftime("%Y-%m-%d %H:%M:%S", time.gmtime())
        with contextlib.suppress(OSError), open(self._path, "a", encoding="utf-8") as file:
            file.write(f"{stamp} UTC, {platform.node()}, process {os.getpid()}: {text.rstrip()}\n")


@contextlib.contextmanager
def warnings_to(log: Log) -> Iterator[None]:
    """Warnings of the block go to the log, not to the console."""
    show = warnings.showwarning

    def note(message, category, filename, lineno, file=None, line=None):
        log.say(warnings.formatwarning(message, category, filename, lineno, line))

    warnings.showwarning = note
    try:
        yield
    finally:
        warnings.showwarning = show
