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
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from sphstudy.catalogue import method_module, scene_module, solver_module
from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.store import identity
from sphstudy.store.provenance import provenance
from sphstudy.store.store import Store, read_summary

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
        flat = config.flat()
        predicted = self._predicted(flat, work, without)
        return _usual(flat, work) if math.isnan(predicted) else predicted

    def left_out(self) -> dict[str, tuple[float, float]]:
        """Predicted and measured CPU seconds of each run, by its record, as all the others predict it;
        NaN where none is like it.
        """
        return {
            one.name: (self._predicted(one.flat, one.work, one.name), one.cpu_seconds)
            for one in self.measurements
        }

    def _predicted(self, flat: dict[str, Any], work: Work, without: str) -> float:
        """CPU time of a run by what runs of its method and solver took; NaN if there are none (s)."""
        if not work.steps:
            return 0.0
        alike = self._alike.get((flat["method"], flat["solve"]))
        return math.nan if alike is None else alike.seconds(flat, work, without)

    @cached_property
    def _alike(self) -> dict[tuple[str, str], "_Alike"]:
        groups: dict[tuple[str, str], list[Measurement]] = {}
        for one in self.measurements:
            groups.setdefault((one.flat["method"], one.flat["solve"]), []).append(one)
        return {key: _Alike(found) for key, found in groups.items()}


class _Alike:
    """Runs of one method and solver, as arrays over them: a study may ask 20 000 times."""

    def __init__(self, measured: list[Measurement]):
        self._names = np.array([m.name for m in measured])
        self._scenes = np.array([m.flat["scene"] for m in measured])
        self._sizes = np.log([m.work.sizes for m in measured])
        self._terms = np.array([m.work.terms for m in measured])
        self._taken = np.array([max(m.cpu_seconds, 1e-3) for m in measured])
        usual = np.array([_usual(m.flat, m.work) for m in measured])
        self._log_rates = np.log(self._taken / usual)
        self._foreign = np.array([m.foreign for m in measured])
        self._settings = [_costing(m.flat) for m in measured]
        self._changed = lru_cache(maxsize=1000)(self._count_changed)

    def seconds(self, flat: dict[str, Any], work: Work, without: str) -> float:
        """CPU time of a run with these settings and this work (s); NaN if there is none to learn from but
        that of the record `without`.
        """
        # Takes long to import, and where nothing is to be run, nothing is predicted.
        from scipy.optimize import nnls

        others = self._names != without
        if not others.any():
            return math.nan
        differences = (self._sizes_apart(work) + self._kinds_apart(flat))[others]
        weights = np.exp(differences.min() - differences)
        terms = self._terms[others] / work.terms / self._taken[others, None]
        # What few runs leave open follows the solver's own measure of cost.
        guess = _usual(flat, work) * math.exp(np.average(self._log_rates[others], weights=weights))
        matrix = np.vstack([weights[:, None] * terms, np.full(terms.shape[1], GUESS / guess)])
        parts, _ = nnls(matrix, np.append(weights, GUESS))
        return float(parts.sum())

    def _sizes_apart(self, work: Work) -> np.ndarray:
        return np.abs(self._sizes - np.log(work.sizes)).sum(axis=1)

    def _kinds_apart(self, flat: dict[str, Any]) -> np.ndarray:
        return (
            CHANGED_SETTING * self._changed(tuple(_costing(flat).items()))
            + OTHER_SCENE * (self._scenes != flat["scene"])
            + OTHER_ORIGIN * self._foreign
        )

    def _count_changed(self, settings: tuple[tuple[str, Any], ...]) -> np.ndarray:
        return np.array([sum(own.get(k) != value for k, value in settings) for own in self._settings])


def rates(store: Store) -> Rates:
    """What the runs in the store that are done took; of very many, an even selection."""
    paths = [path for path in sorted(store.runs.glob("*.nc")) if not path.name.startswith(".")]
    return Rates(tuple(_measurements(store, paths[:: 1 + len(paths) // ENOUGH])))


def _measurements(store: Store, paths: list[Path]) -> Iterable[Measurement]:
    here = provenance()["processor"]
    for path in paths:
        summary = read_summary(path)
        if summary is None or summary.status != "done":
            continue
        try:
            config = validate(json.loads(summary.attributes["configuration"]))
            steps, particles, seconds = (
                summary.numbers[name] for name in ("steps", "particles", "cpu_seconds")
            )
            foreign = summary.attributes["processor"] != here or (
                summary.attributes["numerics_version"] != identity.numerics_version(config)
            )
        except (LookupError, ValueError):
            continue  # of another version: nothing to learn from
        if steps > 0.0:
            own = work(config, steps, particles)
            yield Measurement(path.name, config.flat(), own, seconds, foreign)


def _costing(flat: dict[str, Any]) -> dict[str, Any]:
    """Settings that may change what a step costs; steps themselves are counted."""
    other = ("solve.integrator", "solve.time_step", "solve.count")
    return {key: v for key, v in flat.items() if key.startswith("method.") or key in other}


def _usual(flat: dict[str, Any], work: Work) -> float:
    """CPU time by the solver's own measure of cost and what a unit of it usually takes (s)."""
    solver = solver_module(flat["solve"])
    return solver.cost(work.particles, work.neighbours, work.steps) * solver.SECONDS_PER_COST
