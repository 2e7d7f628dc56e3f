"""How a run is carried out, as far as that changes none of its numbers."""

import dataclasses
from typing import Any

from sphstudy.errors import ConfigurationError
from sphstudy.parameters import checked, count, number, parameters

LONGEST = 1e9
"""Seconds that a run may be given, thirty years: clocks of threads go to some 9e9."""

MOST = 1e6
"""Memory that a run may be given (GiB): limits of the system are 64 bits long."""


@parameters
class Execution:
    """Settings beside the configuration of a run; they are no part of its identity."""

    checkpoint: float = number("wall time between two checkpoints of a long run", "s", gt=0)
    threads: int = count("threads of one run", ge=1)
    time_limit: float | None = number(
        "wall time of a run, after which it ends as timeout", "s", gt=0, le=LONGEST
    )
    memory_limit: float | None = number(
        "memory of a run, beyond which it ends as failed", "GiB", gt=0, le=MOST
    )


GRACE = 120.0
"""Seconds beyond its time limit after which a run that has not ended itself is ended: the start of its
process and compilation do not count against the limit.
"""

SETTINGS = ("results", "retry", "checkpoint", "threads", "time_limit", "memory_limit")
"""Top-level keys that are no part of what a run is."""

RETRIES = ("none", "failed", "timeout", "all")
"""What `retry` may be: which outcomes that are no results are tried again."""


def taken(composed: dict[str, Any]) -> Execution:
    """How a run is to be carried out, taken out of what was composed.

    Parameters
    ----------
    composed : dict
        Settings of a point; those of Execution are removed.

    Raises
    ------
    ConfigurationError
        With every complaint.
    """
    complaints: list[str] = []
    values = {field.name: composed.pop(field.name) for field in dataclasses.fields(Execution)}
    found = checked(Execution, values, "", complaints)
    if complaints:
        raise ConfigurationError(complaints)
    return found


def thread_settings(count: int) -> dict[str, str]:
    """The environment of a process that may use `count` threads; libraries read it as they load."""
    names = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    return dict.fromkeys(names, str(count))
