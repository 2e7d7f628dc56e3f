"""Largest stable time step: by bisection, of the body at rest, shaken a little; beside 2/ω_max."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from sphstudy.model.problem import Problem
from sphstudy.numerics.solvers import growth, timeless
from sphstudy.numerics.solvers.checkpoint import Keeper
from sphstudy.numerics.solvers.explicit import cost, integrator, not_offered
from sphstudy.numerics.solvers.growth import Bracket, Trial
from sphstudy.numerics.solvers.solution import Solution, Variable
from sphstudy.parameters import count, described, number, parameters

__all__ = [
    "HEADLINE",
    "SECONDS_PER_COST",
    "THREADS",
    "Parameters",
    "check",
    "cost",
    "predicted_steps",
    "run",
]

SECONDS_PER_COST = 1e-7
"""CPU time of a step per pair, looks at the energy included, on one Zen 4 core, where no run tells."""

THREADS = False
"""A run takes one thread: to know the limit, small bodies do."""

HEADLINE = (
    "largest_stable_courant",
    "largest_stable_step",
    "predicted_step",
    "predicted_ratio",
    "bracket_width",
    "trials",
)
"""Metrics for tables: a search records no motion, so the scene's metrics do not apply."""


@parameters
class Parameters:
    """How the limit is searched."""

    name: str = described("name of the solver")
    integrator: Literal["auto", "heun", "verlet"] = described(
        "Heun's method (thesis 2.6), velocity Verlet (total Lagrangian only), or the method's own"
    )
    lowest_courant: float = number("C of the shortest step tried, Δt = C Δ/c0 (2.27)", gt=0)
    highest_courant: float = number("C of the longest step tried", gt=0)
    tolerance: float = number("ratio of the steps that enclose the limit, less 1", gt=1e-4, lt=1)
    steps: int = count("steps of a trial that does not blow up before", ge=100)


def check(problem: Problem, config, method) -> Iterator[str]:
    """Complaints: what the method does not offer, bounds in the wrong order, times asked for."""
    solve = config.solve
    yield from not_offered(config, method)
    yield from timeless.check(config)
    if not solve.lowest_courant * (1.0 + solve.tolerance) < solve.highest_courant:
        yield (
            f"solve.lowest_courant={solve.lowest_courant:g}: should be below "
            f"solve.highest_courant={solve.highest_courant:g}"
        )


def predicted_steps(problem: Problem, config, method) -> int:
    """Steps of all trials, if half of those between the bounds blow up."""
    return config.solve.steps * (1 + math.ceil(_halvings(config.solve) / 2))


def _halvings(solve) -> int:
    ratio = solve.highest_courant / solve.lowest_courant
    return max(0, math.ceil(math.log2(math.log(ratio) / math.log1p(solve.tolerance))))


def run(
    problem: Problem,
    config,
    method,
    on_progress: Callable[[int, int], None],
    keeper: Keeper | None = None,
    threads: int = 1,
) -> Solution:
    """Largest step with which the body of the first stage, not loaded and at its places, stays at rest.

    It is shaken by seeded noise, to which what grows fastest at the longest step is added, so that it
    need not first come out of the noise. What the scene itself sets in motion is left out: the limit of
    the linear motion about the body at rest is meant. Where no step is stable, or all are, the limit is
    NaN, and the message says so: a result like any other.
    """
    solve, stage = config.solve, problem.stages[0]
    unit = problem.step_spacing / method.wave_speed(config, problem)
    kind, speed = integrator(config, method), growth.SPEED * problem.body.material.wave_speed
    pairs = 0

    def system(courant: float, velocity: np.ndarray):
        start = replace(
            problem,
            displacement_x=None,
            displacement_y=None,
            velocity_x=speed * velocity[0],
            velocity_y=speed * velocity[1],
        )
        return method.system(start, config, courant * unit, kind)

    shape = growth.noise(problem, config.seed)
    fastest = growth.fastest_growing(system(solve.highest_courant, shape), stage, solve.steps)
    if fastest is not None:
        shape = growth.normalised(shape + fastest)

    def trial(courant: float) -> Trial:
        nonlocal pairs
        tried = system(courant, shape)
        found = growth.shaken(tried, stage, solve.steps, config.seed)
        pairs = max(pairs, tried.pairs)
        return found

    most = 2 + _halvings(solve)
    bounds = solve.lowest_courant, solve.highest_courant
    found = growth.bisect(trial, *bounds, solve.tolerance, lambda trials: on_progress(trials, most))
    on_progress(most, most)
    return Solution(
        message=_message(found),
        steps=found.steps,
        pairs=pairs,
        variables=_variables(found, unit, _predicted(problem, config, method)),
    )


def _message(found: Bracket) -> str:
    if np.isnan(found.stable):
        return f"no stable step found down to C = {found.unstable:g}"
    if np.isnan(found.unstable):
        return f"stable up to C = {found.stable:g}, the longest step tried"
    return ""


def _predicted(problem: Problem, config, method) -> float:
    """2/ω_max (s), Verlet's limit without damping; NaN where the method has no stiffness."""
    if not hasattr(method, "highest_frequency"):
        return np.nan
    return 2.0 / method.highest_frequency(problem, config)


def _variables(found: Bracket, unit: float, predicted: float) -> dict[str, Variable]:
    """`unit` (s): the step of C = 1."""
    courant = found.stable if np.isfinite(found.unstable) else np.nan
    return {
        "largest_stable_step": Variable((), courant * unit, "s", "largest stable time step found"),
        "largest_stable_courant": Variable((), courant, "1", "C of it, Δt = C Δ/c0 (2.27)"),
        "predicted_step": Variable((), predicted, "s", "2/ω_max, Verlet's limit without damping"),
        "predicted_courant": Variable((), predicted / unit, "1", "C of 2/ω_max"),
        "predicted_ratio": Variable(
            (), courant * unit / predicted, "1", "largest stable time step found over 2/ω_max"
        ),
        "bracket_width": Variable(
            (), found.unstable / found.stable - 1.0, "1", "smallest unstable step found over it, less 1"
        ),
        "trials": Variable((), float(found.trials), "1", "time steps tried"),
    }
