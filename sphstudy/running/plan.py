"""What a sweep will do before it does it: which points would run, why, and what they will cost."""

from collections import Counter
from dataclasses import dataclass

from sphstudy.analysis.cost_forecast import prospect, rates
from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import Point
from sphstudy.errors import ConfigurationError
from sphstudy.store.store import REUSED, Store
from sphstudy.store.summary import Summary
from sphstudy.text import duration

TRIED_AGAIN = {
    "none": (),
    "failed": ("failed",),
    "timeout": ("timeout",),
    "all": ("failed", "timeout"),
}
"""Which outcomes each `retry` tries again."""

LONGEST_FORECAST = 30 * 24 * 3600.0
"""CPU time (s) that a run may be predicted to take without a limit of its own."""


@dataclass(frozen=True)
class Planned:
    """A point, the status that the store has of it and its summary there, whether it runs and why;
    predicted CPU time (s) and memory (bytes), if it does.
    """

    point: Point
    status: str
    stored: Summary | None
    seconds: float
    memory: float
    runs: bool
    reason: str


def plan(points: list[Point], store: Store, force: bool = False) -> list[Planned]:
    """What is known of the points before anything runs.

    Raises ConfigurationError with what solvers have to complain about them.
    """
    found, complaints = [], []
    known = None
    for point in points:
        status, stored = store.checked(point.config)
        runs, reason = _decision(status, point.retry, force)
        seconds = memory = 0.0
        # What does not run needs no forecast, which in a study of 20 000 points would take minutes.
        if runs:
            work, wrong = prospect(point.config)
            complaints += wrong
            known = known or rates(store)
            seconds, memory = 0.0 if wrong else known.seconds(point.config, work), _memory(point)
            if seconds > LONGEST_FORECAST and point.execution.time_limit is None:
                complaints.append(
                    f"{point.config.label}: would take about {duration(seconds, 2)} of CPU time; if that "
                    "is meant, say how long it may: time_limit=SECONDS"
                )
        found.append(Planned(point, status, stored, seconds, memory, runs, reason))
    if complaints:
        raise ConfigurationError(complaints)
    return found


def _memory(point: Point) -> float:
    config = point.config
    particles = scene_module(config.scene.kind).particles(config)
    return method_module(config.method.kind).memory(particles, config)


def _decision(status: str, retry: str, force: bool) -> tuple[bool, str]:
    """Whether a point of this status runs, and why."""
    if status == "running":
        return False, "another sweep is computing it"
    if status in ("missing", "interrupted"):
        return True, {"missing": "new", "interrupted": "interrupted: goes on"}[status]
    if force:
        return True, f"forced, stored: {status}"
    if status in REUSED:
        return False, f"stored: {status}"
    if status in TRIED_AGAIN[retry]:
        return True, f"{status}, asked for again"
    return False, f"{status}: retry={status} tries it again"


def prediction(pending: list[Planned]) -> str:
    """How much there is to do."""
    seconds = sum(p.seconds for p in pending)
    return f"{len(pending)} runs to do, about {duration(seconds, 2)} of CPU time"


def kept(planned: list[Planned]) -> str:
    """What is said of failed points that are neither results nor tried again; "" if there are none."""
    counts = Counter(p.status for p in planned if not p.runs and p.status in TRIED_AGAIN["all"])
    return ", ".join(f"{n} {status} (retry={status} runs them again)" for status, n in counts.items())
