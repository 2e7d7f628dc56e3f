"""All that `sphstudy speed` measures, part by part."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from sphstudy.benchmarks.speed import cases, parallel, rates, start, whole_runs
from sphstudy.benchmarks.speed.parallel import Scaling
from sphstudy.benchmarks.speed.rates import Rate
from sphstudy.benchmarks.speed.settings import PARTS, Settings
from sphstudy.benchmarks.speed.start import Start
from sphstudy.benchmarks.speed.whole_runs import WholeRun
from sphstudy.configuration.composition import Session
from sphstudy.numerics.compile_timer import CompileTimer

COPIES = 3
"""Systems of each case, where they are small (rates.measured)."""


@dataclass(frozen=True)
class Part:
    """Cost of measuring one part: CPU seconds of this process and its children, of which it compiled, and
    wall seconds.
    """

    name: str
    cpu_seconds: float
    compile_seconds: float
    wall_seconds: float


@dataclass
class Measurements:
    """All measurements. remarks: what could not be measured, and why."""

    rates: list[Rate] = field(default_factory=list)
    scalings: list[Scaling] = field(default_factory=list)
    starts: list[Start] = field(default_factory=list)
    runs: list[WholeRun] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)


def measure(hydra: Session, settings: Settings, say: Callable[[str], object]) -> Measurements:
    """Measures the parts that the settings name; calls say(name and meaning) before each."""
    found = Measurements()
    for name in settings.parts:
        say(f"{name}: {PARTS[name]}")
        wall, cpu = time.perf_counter(), _cpu()
        with CompileTimer() as compiling:
            _MEASURE[name](hydra, settings, found)
        spent = _cpu() - cpu, compiling.cpu, time.perf_counter() - wall
        found.parts.append(Part(name, *spent))
    for rate in found.rates:
        if rate.wrong:
            found.remarks.append(f"{rate.case.label}: {rate.wrong}, not measured")
    return found


def _cpu() -> float:
    """CPU time of this process and of its children that have ended [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _forms(hydra: Session, settings: Settings, found: Measurements) -> None:
    found.rates += rates.measured(hydra, cases.forms(), settings.rounds, settings.slice_seconds, COPIES)


def _growth(hydra: Session, settings: Settings, found: Measurements) -> None:
    for form in cases.growth(cases.ROWS[: 3 if settings.quick else None]):
        found.rates += rates.measured(hydra, form, settings.rounds, settings.slice_seconds)


def _terms(hydra: Session, settings: Settings, found: Measurements) -> None:
    every = cases.terms(40 if settings.quick else 60)
    found.rates += rates.measured(hydra, every, settings.rounds, settings.slice_seconds, COPIES)


def _threads(hydra: Session, settings: Settings, found: Measurements) -> None:
    seconds = 4.0 * settings.slice_seconds
    scalings, remark = parallel.threads(hydra, 91, settings.rounds, seconds)
    found.scalings += scalings
    found.remarks += [remark] if remark else []


def _processes(hydra: Session, settings: Settings, found: Measurements) -> None:
    period, jobs, rounds = (0.05, 4, 1) if settings.quick else (0.2, 6, min(3, settings.rounds))
    run = ("scene=plate", "method=thesis", "h=1.5", "n=9", f"scene.periods={period:g}")
    found.scalings += parallel.processes(hydra, run, jobs, rounds)


def _start(hydra: Session, settings: Settings, found: Measurements) -> None:
    if settings.quick:
        found.remarks.append("start: compiling into an empty cache takes long, quick leaves it out")
    else:
        found.starts += start.from_empty_cache(3)
    found.starts += start.growing(cases.ROWS[: 2 if settings.quick else None])


def _runs(hydra: Session, settings: Settings, found: Measurements) -> None:
    found.runs += whole_runs.runs(hydra, 1 if settings.quick else min(3, settings.rounds))


_MEASURE: dict[str, Callable[[Session, Settings, Measurements], None]] = {
    "forms": _forms,
    "growth": _growth,
    "terms": _terms,
    "threads": _threads,
    "processes": _processes,
    "start": _start,
    "runs": _runs,
}
