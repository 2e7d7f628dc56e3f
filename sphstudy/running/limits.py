"""A limit of the memory that a run may take."""

import contextlib
import resource
from collections.abc import Iterator

import psutil

GIBIBYTE = 1024**3

LEAST = GIBIBYTE // 16
"""Memory (bytes) that a run needs beside what its process has when it begins."""


def _private_memory() -> int:
    """Bytes of this process that RLIMIT_DATA counts; 0 where the system does not tell."""
    return getattr(psutil.Process().memory_info(), "data", 0)


@contextlib.contextmanager
def memory_limited(gibibytes: float | None) -> Iterator[None]:
    """Limits the private writable memory of this process while the block works; None: no limit.

    Whatever asks for more gets a MemoryError, by the kernel's limit RLIMIT_DATA (Linux since 4.7). A hard
    limit that is lower stays.

    Raises
    ------
    MemoryError
        If the process has nearly as much already: libraries end the process, or try for ever, where they
        cannot have the little that they need to say so.
    """
    if gibibytes is None:
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    wanted, taken = int(gibibytes * GIBIBYTE), _private_memory()
    if wanted < taken + LEAST:
        least = (taken + LEAST) / GIBIBYTE
        raise MemoryError(f"memory_limit={gibibytes:g}: a run takes {least:.2g} GiB before it begins")
    resource.setrlimit(
        resource.RLIMIT_DATA, (wanted if hard == resource.RLIM_INFINITY else min(wanted, hard), hard)
    )
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))
