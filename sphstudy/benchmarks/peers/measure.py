"""Measures every code at every resolution: its own limit, then all cases in turn, again and again."""

import json
import math
import statistics
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from sphstudy.benchmarks.peers.codes import THIS, Code
from sphstudy.benchmarks.peers.launch import Outcome
from sphstudy.benchmarks.peers.limit import NoLimit, stability_limit
from sphstudy.benchmarks.peers.plate import SHORT, Plate
from sphstudy.metrics.oscillation import fit_damped_sine

SHARE = 0.9
"""Share of its own stability limit at which a code is run besides its usual setting."""

CHEAP = 20.0
"""CPU seconds above which a run is not repeated."""

SAMPLES = 100
"""Points of a series. This program takes all totals at each: 400 would cost it as much as its steps."""

Launch = Callable[[Code, dict[str, Any]], Outcome]
"""Runs a code with the settings of its driver."""


@dataclass
class Case:
    """A code at a setting and a resolution, and what came of it.

    setting: "limit", "usual", or "direct" where nothing is stepped; courant: C; share: C over the limit.
    """

    code: Code
    plate: Plate
    setting: str
    courant: float = math.nan
    share: float = math.nan
    status: str = "missing"
    message: str = ""
    seconds: list[float] = field(default_factory=list)
    values: dict[str, Any] = field(default_factory=dict)
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Code, resolution and setting, for people."""
        return f"{self.code.name}, n={self.plate.config.n}, {self.setting}"

    @property
    def cpu_seconds(self) -> float:
        """Median of the repeats [s]; NaN without any."""
        return statistics.median(self.seconds) if self.seconds else math.nan

    def frequency(self) -> tuple[float, float]:
        """ω (rad/s) and residual over amplitude: one fit for all series; a mode as it is."""
        if self.status != "done":
            return math.nan, math.nan
        if "frequency" in self.values:
            return self.values["frequency"], math.nan
        fit = fit_damped_sine(
            np.array(self.values["time"]), np.array(self.values["deflection"]), self.plate.beam_frequency
        )
        return fit.omega, fit.residual


def settings(code: Code, plate: Plate, courant: float, duration: float, folder: Path) -> dict[str, Any]:
    """What a driver is given: body, material, its own settings, time step, length of the run (s)."""
    stepped = code.courant is not None
    given = {**plate.material, "speed_limit": plate.speed_limit}
    if code.peer == THIS:
        overrides = {**code.settings, "n": plate.config.n, "h": code.h}
        if stepped:
            periods = duration / plate.duration
            overrides |= {"solve.courant": courant, "scene.periods": periods, "record.samples": SAMPLES}
        return given | {"overrides": overrides}
    given |= {**code.settings, "h": code.h, "body": str(plate.body(code.columns, folder))}
    if stepped:
        return given | {"time_step": courant * plate.unit, "duration": duration, "samples": SAMPLES}
    # As many nodes across as there are rows of particles.
    return given | {"elements": (plate.config.n - 1) // 2}


def limit(code: Code, plate: Plate, guess: float, launch: Launch, folder: Path) -> float:
    """The largest stable C of a code, from short runs or from its cache. Raises NoLimit."""
    cache = folder / code.peer / "limits.json"
    known = json.loads(cache.read_text()) if cache.exists() else {}
    key = json.dumps([code.name, code.h, code.columns, code.settings, plate.config.n])
    if key not in known:

        def is_stable(courant: float) -> bool:
            short = settings(code, plate, courant, SHORT * courant * plate.unit, folder)
            outcome = launch(code, short)
            if outcome.status in ("failed", "timeout"):
                raise NoLimit(outcome.message)
            return outcome.status == "done"

        known[key] = stability_limit(is_stable, guess)
        cache.parent.mkdir(parents=True, exist_ok=True)
        cache.write_text(json.dumps(known, indent=1))
    return known[key]


def cases(
    codes: list[Code], plate: Plate, guesses: dict[str, float], launch: Launch, folder: Path
) -> Iterator[Case]:
    """All cases of a plate, with the limits measured; one that is not found is an outcome.

    guesses: limits that were found for other plates, by name of the code; the new ones are added.
    """
    for code in codes:
        if code.courant is None:
            yield Case(code, plate, "direct")
            continue
        try:
            largest = limit(code, plate, guesses.get(code.name, code.courant), launch, folder)
        except NoLimit as error:
            yield Case(code, plate, "limit", status="failed", message=str(error))
            yield Case(code, plate, "usual", code.courant)
            continue
        guesses[code.name] = largest
        yield Case(code, plate, "limit", SHARE * largest, SHARE)
        yield Case(code, plate, "usual", code.courant, code.courant / largest)


def run(
    every: list[Case], repeats: int, launch: Launch, folder: Path, after: Callable[[Case], None]
) -> None:
    """Runs all cases in turn, `repeats` times what is cheap; calls after(case) when one has run."""
    # What takes longest at the end: an interruption then costs least.
    ordered = sorted(every, key=lambda case: case.setting == "usual")
    for round_number in range(repeats):
        for case in ordered:
            again = case.status == "done" and case.cpu_seconds < CHEAP
            if not (again if round_number else case.status == "missing"):
                continue
            plate = case.plate
            case.settings = settings(case.code, plate, case.courant, plate.duration, folder)
            outcome = launch(case.code, case.settings)
            case.status, case.message = outcome.status, outcome.message
            if outcome.values:
                case.values = outcome.values
                case.seconds.append(outcome.values["cpu_seconds"])
            after(case)
