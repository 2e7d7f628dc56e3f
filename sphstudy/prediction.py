"""What runs will cost: a sum of terms of their work, fitted to what the runs most like them took.

CPU seconds are taken for c0 + S (c1 N + c2 N m + c3 N m² + c4 N² m), with S steps or linear systems, N
particles and m neighbours each: set-up, work on particles and on pairs, assembly of a stiffness, its
band factorised. No c is negative, so that sizes beyond those measured get sensible times. The c are
found anew for each run, by least squares of relative errors, in which a run weighs the less the more it
differs from the one predicted.
"""

import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import nnls

from sphstudy import identity
from sphstudy.config import RunConfig, method_module, scene_module, solver_module, validate
from sphstudy.provenance import provenance
from sphstudy.store import Store

CHANGED_SETTING = 0.5
"""Difference between two runs of one more differing setting of method or solver, in powers of e."""

OTHER_SCENE = 2.0
"""Difference between runs of different scenes."""

OTHER_ORIGIN = 4.0
"""Difference to a run of another version of the code, or on another processor."""

ENOUGH = 500
"""Runs that are learnt from, at most about twice so many: a forecast looks at each."""

GUESS = 0.1
"""Weight of a guess by the solver's own measure of cost, that of the most similar run being 1."""


@dataclass(frozen=True)
class Work:
    """What a run has to do: steps or linear systems, particles, neighbours of each."""

    steps: float
    particles: float
    neighbours: float

    @property
    def terms(self) -> np.ndarray:
        """What CPU time is a sum of, up to factors [5]."""
        s, n, m = self.steps, self.particles, self.neighbours
        return np.array([1.0, s * n, s * n * m, s * n * m**2, s * n**2 * m])

    @property
    def sizes(self) -> tuple[float, float, float]:
        """All three."""
        return self.steps, self.particles, self.neighbours


@dataclass(frozen=True)
class Measurement:
    """A run that is done: its flat configuration, what it had to do, CPU seconds. foreign: it is of
    another version of the code or another processor. name: of its record.
    """

    name: str
    flat: dict[str, Any]
    work: Work
    cpu_seconds: float
    foreign: bool = False


def prospect(config: RunConfig) -> tuple[Work, list[str]]:
    """What a run has to do, and what the solver has to complain about the problem."""
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    solver, problem = solver_module(config.solve.name), scene.build(config)
    if complaints := list(solver.check(problem, config, method)):
        return Work(0.0, 0.0, 0.0), complaints
    steps = solver.predicted_steps(problem, config, method)
    return work(config, steps, scene.particles(config)), []


def work(config: RunConfig, steps: float, particles: float) -> Work:
    """What a run of so many steps and particles has to do."""
    return Work(steps, particles, method_module(config.method.kind).lattice_neighbours(config))


@dataclass(frozen=True)
class Rates:
    """What is known of the cost of runs."""

    measurements: tuple[Measurement, ...]

    def seconds(self, config: RunConfig, work: Work, without: str = "") -> float:
        """Predicted CPU time of a run (s), compilation apart, but for what the record `without` tells."""
        others = [m for m in self.measurements if m.name != without]
        predicted = _from(others, config.flat(), work)
        return _usual(config.flat(), work) if math.isnan(predicted) else predicted

    def left_out(self) -> dict[str, tuple[float, float]]:
        """Predicted and measured CPU seconds of each run, by its record, as all the others predict it;
        NaN where none is like it.
        """
        found = {}
        for one in self.measurements:
            others = [m for m in self.measurements if m is not one]
            found[one.name] = _from(others, one.flat, one.work), one.cpu_seconds
        return found


def rates(store: Store) -> Rates:
    """What the runs in the store that are done took; of very many, an even selection."""
    paths = [path for path in sorted(store.runs.glob("*.nc")) if not path.name.startswith(".")]
    found = Rates(tuple(_measurements(store, paths[:: 1 + len(paths) // ENOUGH])))
    store.index.flush()
    return found


def _measurements(store: Store, paths: list[Path]) -> Iterable[Measurement]:
    here = provenance()["processor"]
    for path in paths:
        summary = store.summary_at(path)
        if summary is None or summary.status != "done":
            continue
        try:
            config = validate(json.loads(summary.attributes["configuration"]))
            steps, particles, seconds = (
                summary.numbers[name][0] for name in ("steps", "particles", "cpu_seconds")
            )
            foreign = summary.attributes["processor"] != here or (
                summary.attributes["numerics_version"] != identity.numerics_version(config)
            )
        except (LookupError, ValueError):
            continue  # of another version: nothing to learn from
        if steps > 0.0:
            own = work(config, steps, particles)
            yield Measurement(path.name, config.flat(), own, seconds, foreign)


def _from(measured: Iterable[Measurement], flat: dict[str, Any], work: Work) -> float:
    """CPU time of a run by what runs of the same method and solver took; NaN if there are none (s)."""
    alike = [m for m in measured if all(m.flat[key] == flat[key] for key in ("method", "solve"))]
    if not alike or not work.steps:
        return math.nan if work.steps else 0.0
    differences = np.array([_difference(m, flat, work) for m in alike])
    weights = np.exp(differences.min() - differences)
    taken = np.array([max(m.cpu_seconds, 1e-3) for m in alike])
    terms = np.array([m.work.terms for m in alike]) / work.terms / taken[:, None]
    # What few runs leave open follows the solver's own measure of cost.
    rates = taken / [_usual(m.flat, m.work) for m in alike]
    guess = _usual(flat, work) * math.exp(np.average(np.log(rates), weights=weights))
    matrix = np.vstack([weights[:, None] * terms, np.full(terms.shape[1], GUESS / guess)])
    parts, _ = nnls(matrix, np.append(weights, GUESS))
    return float(parts.sum())


def _difference(measured: Measurement, flat: dict[str, Any], work: Work) -> float:
    """How unlike a run is to one with these settings and this work: 0 for the same."""
    sizes = zip(measured.work.sizes, work.sizes, strict=True)
    changed = sum(measured.flat.get(key) != value for key, value in flat.items() if _costs(key))
    return (
        sum(abs(math.log(one / other)) for one, other in sizes)
        + CHANGED_SETTING * changed
        + OTHER_SCENE * (measured.flat["scene"] != flat["scene"])
        + OTHER_ORIGIN * measured.foreign
    )


def _costs(key: str) -> bool:
    """Whether a setting may change what a step costs; steps themselves are counted."""
    return key.startswith("method.") or key in ("solve.integrator", "solve.time_step", "solve.count")


def _usual(flat: dict[str, Any], work: Work) -> float:
    """CPU time by the solver's own measure of cost and what a unit of it usually takes (s)."""
    solver = solver_module(flat["solve"])
    return solver.cost(work.particles, work.neighbours, work.steps) * solver.SECONDS_PER_COST
