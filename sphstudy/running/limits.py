"""A limit of the memory that a run may take."""

import contextlib
import resource
from collections.abc import Iterator

GIBIBYTE = 1024**3


@contextlib.contextmanager
def memory_limited(gibibytes: float | None) -> Iterator[None]:
    """Limits the private writable memory of this process while the block works; None: no limit.

    Whatever asks for more gets a MemoryError, by the kernel's limit RLIMIT_DATA (Linux since 4.7). A hard
    limit that is lower stays.
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
