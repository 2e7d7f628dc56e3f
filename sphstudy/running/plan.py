"""What a sweep will do before it does it: which points would run, why, and what they will cost."""

import json
from collections import Counter
from dataclasses import dataclass
from datetime import datetime, timedelta

from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy.analysis.cost_forecast import prospect, rates
from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import Point
from sphstudy.configuration.run_settings import flattened
from sphstudy.console import console
from sphstudy.errors import ConfigurationError
from sphstudy.running.progress import duration
from sphstudy.store import identity
from sphstudy.store.store import REUSED, Store, read_summary

TRIED_AGAIN = {
    "none": (),
    "failed": ("failed",),
    "timeout": ("timeout",),
    "all": ("failed", "timeout"),
}
"""Which outcomes each `retry` tries again."""


@dataclass(frozen=True)
class Planned:
    """A point, the status that the store has of it, whether it runs and why; predicted CPU time (s) and
    memory (bytes), if it does.
    """

    point: Point
    status: str
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
        status = store.status(point.config)
        runs, reason = _decision(status, point.retry, force)
        seconds = memory = 0.0
        # What does not run needs no forecast, which in a study of 20 000 points would take minutes.
        if runs:
            work, wrong = prospect(point.config)
            complaints += wrong
            known = known or rates(store)
            seconds, memory = 0.0 if wrong else known.seconds(point.config, work), _memory(point)
        found.append(Planned(point, status, seconds, memory, runs, reason))
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


def print_plan(planned: list[Planned], store: Store, workers: int) -> None:
    """A table of the points: whether they would run, why, and what is predicted."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("point", "would run", "because", "CPU (s)", "memory (MB)"):
        table.add_column(heading, justify="right" if "(" in heading else "left")
    older = _older_records(planned, store)
    for p in sorted(planned, key=lambda p: -p.seconds):
        reason = older.get(id(p), p.reason)
        memory = f"{p.memory / 1e6:.0f}"
        table.add_row(p.point.config.label, "yes" if p.runs else "no", reason, f"{p.seconds:.1f}", memory)
    console().print(table)
    pending = [p for p in planned if p.runs]
    print(prediction(pending))
    if pending:
        # No sooner than the longest of them, and no run is shared.
        seconds = max(sum(p.seconds for p in pending) / workers, *(p.seconds for p in pending), 0.0)
        end = datetime.now().astimezone() + timedelta(seconds=seconds)
        most = max(p.memory for p in pending) * min(workers, len(pending)) / 1e6
        print(f"begun now, {workers} at once: done about {end:%a %H:%M}, up to {most:.0f} MB of memory")


def _older_records(planned: list[Planned], store: Store) -> dict[int, str]:
    """For points without a record, why one of the same label does not serve: by id of the point."""
    wanted = {p.point.config.label: p for p in planned if p.status == "missing"}
    found: dict[int, str] = {}
    for path in store.runs.glob("*.nc"):
        label = path.stem.rpartition("-")[0]
        if label not in wanted or (summary := read_summary(path)) is None:
            continue
        p = wanted[label]
        reason = difference(summary.attributes, p.point)
        # The least different of several records tells most.
        if id(p) not in found or len(reason) < len(found[id(p)]):
            found[id(p)] = reason
    return found


def difference(attributes: dict, point: Point) -> str:
    """What sets a stored record apart from a point of the same label."""
    stored = flattened(json.loads(attributes["configuration"]))
    now = point.config.flat()
    changed = [key for key in now if stored.get(key) != now[key]]
    if not changed and attributes["numerics_version"] != identity.numerics_version(point.config):
        return "changed numerics: the code of scene, method or solver"
    told = ", ".join(f"{key}={stored.get(key)} is stored" for key in changed[:3])
    more = f" and {len(changed) - 3} more" if len(changed) > 3 else ""
    return f"new: {told}{more}"


def prediction(pending: list[Planned]) -> str:
    """How much there is to do."""
    seconds = sum(p.seconds for p in pending)
    return f"{len(pending)} runs to do, about {duration(seconds)} of CPU time"


def kept(planned: list[Planned]) -> str:
    """What is said of failed points that are neither results nor tried again; "" if there are none."""
    counts = Counter(p.status for p in planned if not p.runs and p.status in TRIED_AGAIN["all"])
    return ", ".join(f"{n} {status} (retry={status} runs them again)" for status, n in counts.items())
