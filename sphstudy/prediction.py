"""What runs will cost: steps times pairs, turned into seconds by what earlier runs took."""

import json
import statistics
from collections import defaultdict
from dataclasses import dataclass

import netCDF4

from sphstudy.config import RunConfig, method_module, scene_module, solver_module, validate
from sphstudy.record import STATUS
from sphstudy.store import FILES, Store

SECONDS_PER_PAIR_STEP = 4e-8
"""CPU time of a step per pair where the store has no run to learn from, on one Zen 4 core."""


def prospect(config: RunConfig) -> tuple[float, list[str]]:
    """Cost of a run (steps times pairs), and what the solver has to complain about the problem."""
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    solver, problem = solver_module(config.solve.name), scene.build(config)
    steps = solver.predicted_steps(problem, config, method)
    return _cost(config, steps, scene.particles(config)), list(solver.check(problem, config, method))


def _cost(config: RunConfig, steps: float, particles: float) -> float:
    neighbours = method_module(config.method.kind).lattice_neighbours(config)
    return steps * particles * neighbours / 2.0


@dataclass(frozen=True)
class Rates:
    """CPU seconds per unit of cost: of each scene and method in the store, and of all of them."""

    by_kind: dict[tuple[str, str], float]
    overall: float

    def seconds(self, config: RunConfig, cost: float) -> float:
        """Predicted CPU time of a run of this cost (s)."""
        return cost * self.by_kind.get((config.scene.kind, config.method.kind), self.overall)


def rates(store: Store) -> Rates:
    """Medians over the runs in the store that are done."""
    found: dict[tuple[str, str], list[float]] = defaultdict(list)
    for path in store.runs.glob("*.nc"):
        try:
            with FILES, netCDF4.Dataset(path) as run:
                if STATUS[int(run["status"][...])] != "done":
                    continue
                config = validate(json.loads(run.configuration))
                cost = _cost(config, float(run["steps"][...]), float(run["particles"][...]))
                rate = float(run["cpu_seconds"][...]) / cost
        except (OSError, LookupError, AttributeError, ValueError):
            continue  # not readable, or of another version: nothing to learn from
        found[config.scene.kind, config.method.kind].append(rate)
    everything = [rate for several in found.values() for rate in several]
    overall = statistics.median(everything) if everything else SECONDS_PER_PAIR_STEP
    return Rates({kind: statistics.median(several) for kind, several in found.items()}, overall)
