"""Explicit solution: time step, steps of each stage, and the run itself (stepping.py)."""

import math
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Literal

import numba

from sphstudy.model.problem import Problem, Stage
from sphstudy.numerics.solvers.checkpoint import Keeper, NoKeeper
from sphstudy.numerics.solvers.solution import Solution
from sphstudy.numerics.solvers.stepping import Run
from sphstudy.parameters import count, described, number, parameters

SECONDS_PER_COST = 4e-8
"""CPU time of a step per pair, on one Zen 4 core, where no run tells."""

THREADS = True
"""Several threads can share a run."""


@parameters
class Parameters:
    """Time stepping and its protocol of loading and settling."""

    name: str = described("name of the solver")
    integrator: Literal["auto", "heun", "verlet"] = described(
        "Heun's method (thesis 2.6), velocity Verlet (total Lagrangian only), or the method's own"
    )
    time_step: Literal["courant", "frequency"] = described(
        "Δt from the rule (2.27), or from the highest frequency (power iteration; total Lagrangian only)"
    )
    courant: float = number("C of the time step Δt = C Δ/c0 (2.27)", gt=0)
    safety: float = number("Δt over 2/ω_max, its limit without damping", gt=0, lt=1)
    load_steps: int = count("loading steps N (3.4)", ge=1)
    load_time: float | None = number("loading time; replaces load_steps if given", "s", gt=0)
    settle_steps: int = count("steps after loading", ge=1)
    extend_steps: int = count("steps after each extension of the crack", ge=1)
    settle_ratio: float | None = number(
        "end settling when √Σv² is below so much of its value after loading", gt=0, lt=1
    )
    stop_energy_gain: float | None = number(
        "end when so much of the energy put in came from nowhere", gt=0
    )
    stop_spacing: float | None = number("end when particles are closer than so many spacings", gt=0, lt=1)
    stop_hourglass: float | None = number(
        "end when more of the squared deformation is checkerboard", gt=0, lt=1
    )
    stop_mirror: float | None = number("end when mirror images are so many spacings off", gt=0)
    equilibrium_ratio: float = number("what counts as equilibrium reached, the same ratio", gt=0, lt=1)


def plan(stages: tuple[Stage, ...], parameters: Parameters, dt: float) -> list[int]:
    """Steps of each stage, in order."""
    load = parameters.load_steps
    if parameters.load_time is not None:
        load = math.ceil(parameters.load_time / dt)
    steps: list[int] = []
    for stage in stages:
        if stage.duration is not None:
            steps.append(math.ceil(stage.duration / dt))
        elif stage.action == "load":
            steps.append(load)
        elif stage.until is not None:
            steps.append(max(1, math.ceil(stage.until / dt) - sum(steps)))
        else:
            steps.append(parameters.extend_steps if stage.extension else parameters.settle_steps)
    return steps


def time_step(problem: Problem, config, method) -> float:
    """Δt = C Δ/c0 (2.27), or the chosen share of 2/ω_max [s]."""
    if config.solve.time_step == "frequency":
        return config.solve.safety * 2.0 / _highest_frequency(problem, config, method)
    return config.solve.courant * problem.step_spacing / method.wave_speed(config, problem)


# Complaints and forecasts ask for one and the same problem's in a row.
@lru_cache(maxsize=1)
def _highest_frequency(problem: Problem, config, method) -> float:
    return method.highest_frequency(problem, config)


def integrator(config, method) -> str:
    """The integrator of a run: the method's own, its first, unless another is asked for."""
    asked = config.solve.integrator
    return method.INTEGRATORS[0] if asked == "auto" else asked


def not_offered(config, method) -> Iterator[str]:
    """Complaints about an integrator that the method does not have."""
    solve, name = config.solve, config.method.name
    if integrator(config, method) not in method.INTEGRATORS:
        offered = ", ".join(method.INTEGRATORS)
        yield f"solve.integrator={solve.integrator}: method {name} takes {offered}"


def check(problem: Problem, config, method) -> Iterator[str]:
    """Complaints: what the method does not offer, and times asked for that the run does not reach."""
    yield from not_offered(config, method)
    if config.solve.time_step == "frequency" and not hasattr(method, "highest_frequency"):
        name = config.method.name
        yield f"solve.time_step=frequency: method {name} has no stiffness to find ω_max of; take courant"
        return
    dt = time_step(problem, config, method)
    end = dt * predicted_steps(problem, config, method)
    for wanted in config.record.times:
        if not 0.0 <= wanted <= end:
            yield f"record.times={wanted:g}: {config.label} runs from 0 to {end:.6g} s"


def predicted_steps(problem: Problem, config, method) -> int:
    """Steps of a run that is not stopped early."""
    dt = time_step(problem, config, method)
    return sum(plan(problem.stages, config.solve, dt))


def cost(particles: int, neighbours: float, steps: float) -> float:
    """What a run's CPU time goes with: evaluations of pairs."""
    return steps * particles * neighbours / 2.0


def run(
    problem: Problem,
    config,
    method,
    on_progress: Callable[[int, int], None],
    keeper: Keeper | None = None,
    threads: int = 1,
) -> Solution:
    """Solves the problem by explicit stepping; calls on_progress(step, steps) between chunks.

    Goes on from the keeper's checkpoint, if it has one, and hands it a new one whenever that is due.
    `threads` share the sums over pairs, as far as the process has them; their number changes no bit.
    """
    threads = min(threads, numba.config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]
    if threads > 1:
        numba.set_num_threads(threads)
    dt = time_step(problem, config, method)
    steps = plan(problem.stages, config.solve, dt)
    system = method.system(problem, config, dt, integrator(config, method), threads)
    return Run(problem, config, system, dt, steps, on_progress, keeper or NoKeeper()).solve()
