"""Static solution: one equilibrium a stage, solved directly instead of stepped to."""

from collections.abc import Callable, Iterator

import numpy as np

from sphstudy.model.problem import Problem, Stage
from sphstudy.numerics.solvers import timeless
from sphstudy.numerics.solvers.checkpoint import Keeper
from sphstudy.numerics.solvers.factorisation import NotSolvable
from sphstudy.numerics.solvers.indicators import Indicators
from sphstudy.numerics.solvers.newton import Effort, Newton
from sphstudy.numerics.solvers.potential_system import closure_work, fields, internal_force, totals
from sphstudy.numerics.solvers.solution import Snapshot, Solution, Variable
from sphstudy.parameters import count, described, number, parameters

SECONDS_PER_COST = 1e-6
"""CPU time of a linear system per particle^1.5, on one Zen 4 core, where no run tells."""

THREADS = False
"""A run takes one thread: on two, BLAS adds in another order."""

USUAL_ITERATIONS = 5
"""Of Newton's method, for a forecast."""

CUTBACKS = 6
"""How often an increment that fails is halved."""


@parameters
class Parameters:
    """Newton's method and its increments."""

    name: str = described("name of the solver")
    increments: int = count("steps in which the load is put on", ge=1)
    tolerance: float = number(
        "residual: norm of forces on free particles over that on all", gt=0, lt=1e-3
    )
    iterations: int = count("of Newton's method in an increment, at most", ge=1)


def check(problem: Problem, config, method) -> Iterator[str]:
    """Complaints: a problem that does not come to rest."""
    for stage in problem.stages:
        if stage.action == "run":
            yield (
                f"solve=equilibrium: stage {stage.name} of scene {config.scene.name} moves freely; "
                "take modes or explicit"
            )
    yield from timeless.check(config)


def predicted_steps(problem: Problem, config, method) -> int:
    """Linear systems that will be solved, more or less."""
    each = 1 if config.method.law == "linear" else USUAL_ITERATIONS
    return each * (len(problem.stages) - 1 + config.solve.increments)


def cost(particles: int, neighbours: float, steps: float) -> float:
    """What a run's CPU time goes with: factorisations of a matrix of a plane body."""
    return steps * particles**1.5


def run(
    problem: Problem,
    config,
    method,
    on_progress: Callable[[int, int], None],
    keeper: Keeper | None = None,
    threads: int = 1,
) -> Solution:
    """Solves each stage for its equilibrium; calls on_progress(stage, stages) after each.

    An equilibrium that cannot be found, or is not stable, ends the run as "diverged", and the message
    says why. Keeps no checkpoints: a stage is a matter of seconds.
    """
    return _Statics(problem, config, method).solve(on_progress)


class _Statics:
    """A run in progress: positions [2N] (m), and what they took."""

    def __init__(self, problem: Problem, config, method):
        self.problem, self.config, self.method = problem, config, method
        self.position = problem.start.ravel()
        self.indicators = Indicators(problem)
        self.effort, self.solution = Effort(), Solution()
        self._enter(problem.stages[0].crack_nodes)

    def solve(self, on_progress: Callable[[int, int], None]) -> Solution:
        stages, solution = self.problem.stages, self.solution
        for number_of, stage in enumerate(stages, 1):
            begun = self.effort.systems
            try:
                self._rest(stage)
            except NotSolvable as wrong:
                solution.outcome, solution.message = "diverged", f"{wrong} (stage {stage.name})"
                break
            finally:
                solution.steps = self.effort.systems
                solution.stage_steps[stage.name] = self.effort.systems - begun
            on_progress(number_of, len(stages))
        solution.variables = {
            "equilibrium_residual": Variable(
                (), self.effort.residual, "1", "largest residual: free forces over all forces"
            ),
            "factor_entries": Variable(
                (), float(self.effort.entries), "1", "entries of the factors of the stiffness, at most"
            ),
        }
        return solution

    def _rest(self, stage: Stage) -> None:
        """Brings the body to rest in this stage's configuration and keeps it."""
        released = self._renew(stage)
        if stage.action == "load":
            self._load(stage)
        else:
            self.position = self.newton.equilibrium(self.position, 1.0)
        place, still = self.position.reshape(2, -1), np.zeros((2, self.problem.body.x.size))
        sums = totals(self.model, place, still, 0.0)
        i, body = self.problem.tracked, self.problem.body
        moved = (place[0, i] - body.x[i], place[1, i] - body.y[i])
        seen = self.indicators.measure(place)
        self.solution.history.append((0.0, float(self.effort.systems), *moved, *sums, *seen))
        self.solution.snapshots.append(
            Snapshot(
                stage.name,
                0.0,
                self.effort.systems,
                fields(self.model, place, still),
                sums.strain_energy,
                closure_work(self.model, released, place),
            )
        )

    def _renew(self, stage: Stage) -> np.ndarray | None:
        """Makes the model that of this stage; change of the forces [2, N] (N/m) if bonds are cut."""
        if stage.crack_nodes == self.nodes:
            return None
        x, y = self.position.reshape(2, -1)
        before = internal_force(self.model, x, y)
        self._enter(stage.crack_nodes)
        return internal_force(self.model, x, y) - before

    def _enter(self, crack_nodes: int) -> None:
        """Opens so many nodes of the crack."""
        solve, self.nodes = self.config.solve, crack_nodes
        self.model = self.method.model(self.problem, self.config, crack_nodes)
        self.solution.pairs = max(self.solution.pairs, self.model.bonds.total)
        self.newton = Newton(self.model, solve.tolerance, solve.iterations, self.effort)

    def _load(self, stage: Stage) -> None:
        """From amplitude 0 to 1 in increments, halved where one fails."""
        reached, increment = 0.0, 1.0 / self.config.solve.increments
        smallest = increment * 0.5**CUTBACKS
        while reached < 1.0:
            amplitude = min(1.0, reached + increment)
            # Not to end a hair's breadth before the full load.
            amplitude = 1.0 if 1.0 - amplitude < 1e-9 else amplitude
            try:
                self.position = self.newton.equilibrium(self.position, amplitude)
                reached = amplitude
            except NotSolvable as wrong:
                increment *= 0.5
                if increment < smallest or not self.model.law.objective:
                    raise NotSolvable(f"{wrong} at {amplitude:.4g} of the load") from None
