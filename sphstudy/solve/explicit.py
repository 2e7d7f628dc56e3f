"""Explicit solution: time step, steps of each stage, and the run itself (stepping.py)."""

import math
from collections.abc import Callable, Iterator

from sphstudy.parameters import count, described, number, parameters
from sphstudy.scenes.problem import Problem, Stage
from sphstudy.solve.checkpoint import Keeper, NoKeeper
from sphstudy.solve.stepping import Run, Solution


@parameters
class Parameters:
    """Time stepping and its protocol of loading and settling."""

    name: str = described("name of the solver")
    courant: float = number("C of the time step Δt = C Δ/c0 (2.27)", gt=0)
    damping: float = number("velocity damping γ (2.23)", "1/s", ge=0)
    smoothing: float = number("smearing of the velocity η (2.26)", ge=0, le=1)
    load_steps: int = count("loading steps N (3.4)", ge=1)
    load_time: float | None = number("loading time; replaces load_steps if given", "s", gt=0)
    settle_steps: int = count("steps after loading", ge=1)
    extend_steps: int = count("steps after each extension of the crack", ge=1)
    settle_ratio: float | None = number(
        "end settling when √Σv² is below so much of its value after loading", gt=0, lt=1
    )
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


def time_step(problem: Problem, parameters: Parameters, wave_speed: float) -> float:
    """Δt = C Δ/c0 (2.27) [s]."""
    return parameters.courant * problem.step_spacing / wave_speed


def check(problem: Problem, config, method) -> Iterator[str]:
    """Complaints that need the problem: times asked for that the run does not reach."""
    dt = time_step(problem, config.solve, method.wave_speed(config, problem))
    end = dt * predicted_steps(problem, config, method)
    for wanted in config.record.times:
        if not 0.0 <= wanted <= end:
            yield f"record.times={wanted:g}: {config.label} runs from 0 to {end:.6g} s"


def predicted_steps(problem: Problem, config, method) -> int:
    """Steps of a run that is not stopped early."""
    dt = time_step(problem, config.solve, method.wave_speed(config, problem))
    return sum(plan(problem.stages, config.solve, dt))


def run(
    problem: Problem,
    config,
    method,
    on_progress: Callable[[int, int], None],
    keeper: Keeper | None = None,
) -> Solution:
    """Solves the problem by explicit stepping; calls on_progress(step, steps) between chunks.

    Goes on from the keeper's checkpoint, if it has one, and hands it a new one whenever that is due.
    """
    dt = time_step(problem, config.solve, method.wave_speed(config, problem))
    steps = plan(problem.stages, config.solve, dt)
    return Run(problem, config, method, dt, steps, on_progress, keeper or NoKeeper()).solve()
