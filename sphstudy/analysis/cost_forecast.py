"""What runs will cost: the solver's own measure of cost, scaled by what runs like them took.

Runs are like each other if method, solver, scene, numerics and processor are the same. Set-up counts more
in small runs than in large ones, so like runs of about the same cost tell most.
"""

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sphstudy.catalogue import method_module, scene_module, solver_module
from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.store import identity
from sphstudy.store.provenance import provenance
from sphstudy.store.store import Store, read_summary

NEAREST = 5
"""Like runs whose median scales a forecast: those nearest in cost."""

ENOUGH = 500
"""Records from which every second, third, … one is read only."""


@dataclass(frozen=True)
class Work:
    """What a run has to do: steps or linear systems, particles, neighbours of each."""

    steps: float
    particles: float
    neighbours: float


@dataclass(frozen=True)
class Measurement:
    """A run that is done: name of its record, configuration, what it had to do, CPU time taken (s)."""

    name: str
    config: RunConfig
    work: Work
    cpu_seconds: float


def prospect(config: RunConfig) -> tuple[Work, list[str]]:
    """What a run has to do, and what the solver has to complain about the problem."""
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    solver, problem = solver_module(config.solve.name), scene.build(config)
    if complaints := list(solver.check(problem, config, method)):
        return Work(0.0, 0.0, 0.0), complaints
    return work(config, solver.predicted_steps(problem, config, method), scene.particles(config)), []


def work(config: RunConfig, steps: float, particles: float) -> Work:
    """What a run of this configuration has to do, from its steps and particles."""
    return Work(steps, particles, method_module(config.method.kind).lattice_neighbours(config))


class Rates:
    """What `measurements` tell of the CPU time of other runs."""

    def __init__(self, measurements: Iterable[Measurement]):
        self.measurements = tuple(measurements)
        groups = defaultdict(list)
        for m in self.measurements:
            groups[_kind(m.config)].append((m.name, _usual(m.config, m.work), m.cpu_seconds))
        # As arrays over the runs: a study may ask 20 000 times.
        self._alike = {
            kind: [np.array(v) for v in zip(*runs, strict=True)] for kind, runs in groups.items()
        }

    def seconds(self, config: RunConfig, work: Work, without: str = "") -> float:
        """Predicted CPU time of a run (s), compilation apart; the record `without` is not learnt from."""
        usual = _usual(config, work)
        if not work.steps or _kind(config) not in self._alike:
            return usual
        names, others, taken = self._alike[_kind(config)]
        nearest = np.argsort(np.abs(np.log(others / usual)), kind="stable")
        nearest = nearest[names[nearest] != without][:NEAREST]
        return usual * float(np.median(taken[nearest] / others[nearest])) if nearest.size else usual


def rates(store: Store) -> Rates:
    """What the runs in the store that are done took, on this processor and by this version's numerics."""
    paths = list(store.files())
    return Rates(_measurements(paths[:: 1 + len(paths) // ENOUGH]))


def _measurements(paths: list[Path]) -> Iterator[Measurement]:
    here = provenance()["processor"]
    for path in paths:
        summary = read_summary(path)
        if summary is None or summary.status != "done":
            continue
        try:
            of, numbers = summary.attributes, summary.numbers
            config = validate(json.loads(of["configuration"]))
            alike = (of["processor"], of["numerics_version"]) == (here, identity.numerics_version(config))
            done = work(config, numbers["steps"], numbers["particles"])
            if alike and done.steps > 0.0:
                yield Measurement(path.name, config, done, numbers["cpu_seconds"])
        except (LookupError, ValueError):
            continue  # of another version: nothing to learn from


def _kind(config: RunConfig) -> tuple[str, ...]:
    return config.method.name, config.solve.name, config.scene.name


def _usual(config: RunConfig, work: Work) -> float:
    """CPU time by the solver's own measure of cost and what a unit of it usually takes (s)."""
    solver = solver_module(config.solve.name)
    return solver.cost(work.particles, work.neighbours, work.steps) * solver.SECONDS_PER_COST
