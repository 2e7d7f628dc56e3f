"""What runs will cost: a solver's measure of work, turned into seconds by what earlier runs took."""

import json
import statistics
from collections import defaultdict
from dataclasses import dataclass

import netCDF4

from sphstudy.config import RunConfig, method_module, scene_module, solver_module, validate
from sphstudy.record import STATUS
from sphstudy.store import FILES, Store


def prospect(config: RunConfig) -> tuple[float, list[str]]:
    """Cost of a run, in its solver's measure, and what the solver has to complain about the problem."""
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    solver, problem = solver_module(config.solve.name), scene.build(config)
    if complaints := list(solver.check(problem, config, method)):
        return 0.0, complaints
    return _cost(config, solver.predicted_steps(problem, config, method), scene.particles(config)), []


def _cost(config: RunConfig, steps: float, particles: int) -> float:
    neighbours = method_module(config.method.kind).lattice_neighbours(config)
    return solver_module(config.solve.name).cost(particles, neighbours, steps)


@dataclass(frozen=True)
class Rates:
    """CPU seconds per unit of cost: of each scene, method and solver in the store, and of each solver."""

    by_kind: dict[tuple[str, str, str], float]
    by_solver: dict[str, float]

    def seconds(self, config: RunConfig, cost: float) -> float:
        """Predicted CPU time of a run of this cost (s)."""
        solver = config.solve.name
        untried = self.by_solver.get(solver, solver_module(solver).SECONDS_PER_COST)
        return cost * self.by_kind.get((config.scene.kind, config.method.kind, solver), untried)


def rates(store: Store) -> Rates:
    """Medians over the runs in the store that are done."""
    by_kind: dict[tuple[str, str, str], list[float]] = defaultdict(list)
    by_solver: dict[str, list[float]] = defaultdict(list)
    for path in store.runs.glob("*.nc"):
        try:
            with FILES, netCDF4.Dataset(path) as run:
                if STATUS[int(run["status"][...])] != "done":
                    continue
                config = validate(json.loads(run.configuration))
                cost = _cost(config, float(run["steps"][...]), int(run["particles"][...]))
                rate = float(run["cpu_seconds"][...]) / cost
        except (OSError, LookupError, AttributeError, ValueError):
            continue  # not readable, or of another version: nothing to learn from
        by_kind[config.scene.kind, config.method.kind, config.solve.name].append(rate)
        by_solver[config.solve.name].append(rate)
    return Rates(
        {kind: statistics.median(several) for kind, several in by_kind.items()},
        {solver: statistics.median(several) for solver, several in by_solver.items()},
    )
