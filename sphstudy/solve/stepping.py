"""One explicit run, stage by stage: chunks of steps, samples, snapshots, and what went wrong when."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from sphstudy.scenes.problem import Problem, Stage
from sphstudy.solve.checkpoint import Checkpoint, Keeper
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
    neighbours_at,
    rates,
)

CHUNK_SECONDS = 0.25
"""Aim for the length of one compiled call: signals, progress and limits act between calls."""


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


class Run:
    """One explicit run in progress: steps of size `dt` (s), so many in each stage."""

    def __init__(
        self,
        problem: Problem,
        config,
        method,
        dt: float,
        steps: list[int],
        on_progress: Callable[[int, int], None],
        keeper: Keeper,
    ):
        self.problem, self.config, self.method = problem, config, method
        self.on_progress, self.keeper = on_progress, keeper
        self.dt, self.steps, self.total = dt, steps, sum(steps)
        self.stride = max(1, self.total // config.record.samples)
        body = problem.body
        self.state = np.zeros((STATE_ROWS, body.x.size))
        self.state[X], self.state[Y] = body.x, body.y
        self.state[VX], self.state[VY] = problem.velocity_x, problem.velocity_y
        self.state[RHO] = body.material.density
        self.requested = sorted({round(t / self.dt) for t in config.record.times})
        self.solution = Solution(time_step=self.dt)
        self.loading_speed = math.nan
        self._rate = np.zeros_like(self.state)
        self._chunk = 1

    def solve(self) -> Solution:
        """Runs all stages, or until the run goes bad or is told to stop; goes on from a checkpoint."""
        kept = self.keeper.load()
        if kept:
            self._restore(kept)
        step = kept.step if kept else 0
        for index in range(kept.stage if kept else 0, len(self.steps)):
            stage = self.problem.stages[index]
            self.stage, self.begun = index, kept.begun if kept else step
            step = self._run_stage(stage, step, self.begun + self.steps[index], kept)
            kept = None
            self.solution.steps = step
            self.solution.stage_steps[stage.name] = step - self.begun
            if self.solution.outcome != "done":
                return self.solution
            self._snapshot(stage.name, step)
            if stage.action == "load":
                self.loading_speed = self._system_speed()
        self._snapshot_if_requested(step)
        return self.solution

    def _run_stage(self, stage: Stage, step: int, end: int, kept: Checkpoint | None) -> int:
        model = self.method.model(self.problem, self.config, stage.crack_nodes)
        self.model = model
        self.amplitude_rate = 1.0 / ((end - self.begun) * self.dt) if stage.action == "load" else 0.0
        self.memory = buffers(model, self.state.shape[1])
        if kept:
            self.pairs = neighbours_at(model, kept.list_x, kept.list_y, kept.list_skin)
        elif not self._renew_neighbours():
            self._diverged(stage, step)
            return step
        else:
            # Once with this stage's motion of the constraints, again at its end: the power of the
            # constraints jumps between stages, and its integral must not smear the jump.
            self._sample(step)
        ratio = self.config.solve.settle_ratio if stage.action == "settle" else None
        while step < end:
            self._snapshot_if_requested(step)
            stop = self._next_event(step, end)
            step, sound = self._chunked(step, stop)
            if not sound:
                self._diverged(stage, step)
                return step
            self._sample(step)
            if ratio and self._system_speed() < ratio * self.loading_speed:
                return step
        return end

    def _next_event(self, step: int, end: int) -> int:
        events = [end, (step // self.stride + 1) * self.stride]
        events += [r for r in self.requested if r > step]
        return min(events)

    def _chunked(self, step: int, stop: int) -> tuple[int, bool]:
        event = step
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
            # Between events only: at the last one its snapshot has been taken, at the next one not yet.
            if event < step < stop and self.keeper.due():
                self.keeper.save(self._checkpoint(step))
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

    def _checkpoint(self, step: int) -> Checkpoint:
        snapshots = self.solution.snapshots
        return Checkpoint(
            stage=self.stage,
            begun=self.begun,
            step=step,
            loading_speed=self.loading_speed,
            state=self.state,
            list_x=self.pairs.built_x,
            list_y=self.pairs.built_y,
            list_skin=self.pairs.skin,
            history=np.array(self.solution.history),
            stage_steps=np.array(list(self.solution.stage_steps.values()), np.int64),
            snapshot_labels=np.array([s.label for s in snapshots], dtype=str),
            snapshot_steps=np.array([s.step for s in snapshots], np.int64),
            snapshot_states=np.array([s.state for s in snapshots]).reshape(-1, *self.state.shape),
            pairs=self.solution.pairs,
        )

    def _restore(self, kept: Checkpoint) -> None:
        self.state[:] = kept.state
        self.loading_speed = kept.loading_speed
        names = (stage.name for stage in self.problem.stages)
        self.solution.stage_steps = dict(zip(names, kept.stage_steps.tolist(), strict=False))
        self.solution.history = [tuple(row) for row in kept.history]
        self.solution.pairs = kept.pairs
        for label, step, state in zip(
            kept.snapshot_labels, kept.snapshot_steps, kept.snapshot_states, strict=True
        ):
            self.solution.snapshots.append(Snapshot(str(label), step * self.dt, int(step), state))

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
