"""Explicit solution, stage by stage: chunks of steps, samples, snapshots, and what went wrong when."""

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from sphstudy.parameters import count, described, number, parameters
from sphstudy.scenes.problem import Problem, Stage
from sphstudy.solve.heun import OUTDATED, UNSOUND, advance, buffers
from sphstudy.sph import invariants
from sphstudy.sph.neighbours import look, outdated
from sphstudy.sph.updated_lagrangian import (
    RHO,
    STATE_ROWS,
    VX,
    VY,
    X,
    Y,
    build_neighbours,
    fastest,
    rates,
)

CHUNK_SECONDS = 0.25
"""Aim for the length of one compiled call: signals, progress and limits act between calls."""


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


@dataclass
class Snapshot:
    """State [8, N] at the end of a stage or at a requested time."""

    label: str
    time: float
    step: int
    state: np.ndarray


@dataclass
class Solution:
    """Everything a run leaves: snapshots, sampled history, how it ended."""

    snapshots: list[Snapshot] = field(default_factory=list)
    history: list[tuple[float, ...]] = field(default_factory=list)
    stage_steps: dict[str, int] = field(default_factory=dict)
    outcome: str = "done"
    message: str = ""
    steps: int = 0
    pairs: int = 0
    time_step: float = 0.0


HISTORY = ("time", "step", "u_x", "u_y", *invariants.Invariants._fields)
"""Columns of Solution.history."""


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


class Run:
    """One explicit run in progress."""

    def __init__(self, problem: Problem, config, method, on_progress: Callable[[int, int], None]):
        self.problem, self.config, self.method = problem, config, method
        self.on_progress = on_progress
        self.wave_speed = method.wave_speed(config, problem)
        self.dt = time_step(problem, config.solve, self.wave_speed)
        self.steps = plan(problem.stages, config.solve, self.dt)
        self.total = sum(self.steps)
        self.stride = max(1, self.total // config.record.samples)
        body = problem.body
        self.state = np.zeros((STATE_ROWS, body.x.size))
        self.state[X], self.state[Y] = body.x, body.y
        self.state[VX], self.state[VY] = problem.velocity_x, problem.velocity_y
        self.state[RHO] = body.material.density
        self.requested = sorted({round(t / self.dt) for t in config.record.times})
        self.solution = Solution(time_step=self.dt)
        self._rate = np.zeros_like(self.state)
        self._chunk = 1

    def solve(self) -> Solution:
        """Runs all stages, or until the run goes bad or is told to stop."""
        step = 0
        loading_speed = None
        for stage, steps in zip(self.problem.stages, self.steps, strict=True):
            begun = step
            step = self._run_stage(stage, step, step + steps, loading_speed)
            self.solution.steps = step
            self.solution.stage_steps[stage.name] = step - begun
            if self.solution.outcome != "done":
                return self.solution
            self._snapshot(stage.name, step)
            if stage.action == "load":
                loading_speed = self._system_speed()
        self._snapshot_if_requested(step)
        return self.solution

    def _run_stage(self, stage: Stage, step: int, end: int, loading_speed: float | None) -> int:
        model = self.method.model(self.problem, self.config, stage.crack_nodes)
        self.model = model
        self.amplitude_rate = 1.0 / ((end - step) * self.dt) if stage.action == "load" else 0.0
        self.memory = buffers(model, self.state.shape[1])
        if not self._renew_neighbours():
            self._diverged(stage, step)
            return step
        ratio = self.config.solve.settle_ratio if stage.action == "settle" else None
        # Once with this stage's motion of the constraints, again at its end: the power of the constraints
        # jumps between stages, and its integral must not smear the jump.
        self._sample(step)
        while step < end:
            self._snapshot_if_requested(step)
            stop = self._next_event(step, end)
            step, sound = self._chunked(step, stop)
            if not sound:
                self._diverged(stage, step)
                return step
            self._sample(step)
            if ratio and loading_speed and self._system_speed() < ratio * loading_speed:
                return step
        return end

    def _next_event(self, step: int, end: int) -> int:
        events = [end, (step // self.stride + 1) * self.stride]
        events += [r for r in self.requested if r > step]
        return min(events)

    def _chunked(self, step: int, stop: int) -> tuple[int, bool]:
        while step < stop:
            chunk = min(step + self._chunk, stop)
            begun = time.perf_counter()
            reached, reason = advance(
                self.model, self.state, self.pairs, self.memory, self.amplitude_rate, self.dt, step, chunk
            )
            if reached > step:
                per_step = max((time.perf_counter() - begun) / (reached - step), 1e-9)
                # The first call may have compiled: never trust one measurement by more than doubling.
                self._chunk = int(min(2 * self._chunk, max(1.0, CHUNK_SECONDS / per_step)))
            step = reached
            self.on_progress(step, self.total)
            if reason == UNSOUND or (reason == OUTDATED and not self._renew_neighbours()):
                return step, False
        return step, True

    def _renew_neighbours(self) -> bool:
        """A new neighbour list; False if something moves too fast for any."""
        stride = self.dt * fastest(self.model, self.state, self.amplitude_rate)
        pairs = build_neighbours(self.model, self.state, stride)
        if pairs is None:
            return False
        self.pairs = pairs
        self.solution.pairs = max(self.solution.pairs, pairs.total)
        return True

    def _sample(self, step: int) -> None:
        # A list built here is not handed on: looking must not change what is looked at.
        pairs = self.pairs
        if outdated(pairs, self.state[X], self.state[Y], 0.0):
            pairs = build_neighbours(self.model, self.state) or pairs
        look(pairs, self.state[X], self.state[Y], self.model.crack)
        rates(self.model, self.state, pairs, self.amplitude_rate, self.memory.work, self._rate)
        totals = invariants.measure(
            self.state,
            self._rate,
            self.problem.body.mass,
            *self.problem.energy_compliance,
            self.problem.constraints,
            self.amplitude_rate,
            pairs,
        )
        i, body = self.problem.tracked, self.problem.body
        moved = (self.state[X, i] - body.x[i], self.state[Y, i] - body.y[i])
        self.solution.history.append((step * self.dt, float(step), *moved, *totals))

    def _snapshot_if_requested(self, step: int) -> None:
        if step in self.requested:
            self._snapshot(f"t={step * self.dt:.6g}", step)

    def _snapshot(self, label: str, step: int) -> None:
        self.solution.snapshots.append(Snapshot(label, step * self.dt, step, self.state.copy()))

    def _system_speed(self) -> float:
        return float(np.sqrt((self.state[VX] ** 2 + self.state[VY] ** 2).sum()))

    def _diverged(self, stage: Stage, step: int) -> None:
        finite = bool(np.isfinite(self.state).all())
        indicator = "a density ≤ 0 or a step too far" if finite else "a value that is not finite"
        self.solution.outcome = "diverged"
        self.solution.message = (
            f"{indicator} at step {step} of {self.total} (t = {step * self.dt:.6g} s, stage {stage.name})"
        )


def run(problem: Problem, config, method, on_progress: Callable[[int, int], None]) -> Solution:
    """Solves the problem by explicit stepping; calls on_progress(step, steps) between chunks."""
    return Run(problem, config, method, on_progress).solve()
