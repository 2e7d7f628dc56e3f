"""One explicit run, stage by stage: chunks of steps, samples, snapshots, and what went wrong when."""

import math
import time
from collections.abc import Callable

import numpy as np

from sphstudy.model.problem import Problem, Stage
from sphstudy.numerics.solvers.checkpoint import Checkpoint, Keeper
from sphstudy.numerics.solvers.indicators import Indicators
from sphstudy.numerics.solvers.limits import breached
from sphstudy.numerics.solvers.solution import FIELDS, HISTORY, LAST_GOOD, Snapshot, Solution
from sphstudy.numerics.solvers.system import System

CHUNK_SECONDS = 0.25
"""Aim for the length of one compiled call: signals, progress and limits act between calls."""

_SPEED, _ENERGY = HISTORY.index("system_speed"), HISTORY.index("strain_energy")


def requested_steps(record, dt: float, total: int) -> list[int]:
    """Steps at which fields are kept: those next to the times asked for, and evenly spaced frames."""
    frames = (round(k * total / max(1, record.frames - 1)) for k in range(record.frames))
    return sorted({*(round(t / dt) for t in record.times), *frames})


class Run:
    """One explicit run in progress: steps of size `dt` (s), so many in each stage."""

    def __init__(
        self,
        problem: Problem,
        config,
        system: System,
        dt: float,
        steps: list[int],
        on_progress: Callable[[int, int], None],
        keeper: Keeper,
    ):
        self.problem, self.config, self.system = problem, config, system
        self.on_progress, self.keeper = on_progress, keeper
        self.dt, self.steps, self.total = dt, steps, sum(steps)
        self.stride = max(1, self.total // config.record.samples)
        self.requested = requested_steps(config.record, dt, self.total)
        self.solution = Solution(time_step=self.dt)
        self.indicators = Indicators(problem)
        self._good = Snapshot(LAST_GOOD, 0.0, 0, system.fields(), 0.0)
        self._wave_speed = problem.body.material.wave_speed
        self._spacing = min(problem.body.spacing_x, problem.body.spacing_y)
        self.loading_speed = math.nan
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
            self.solution.steps, self.solution.pairs = step, self.system.pairs
            self.solution.stage_steps[stage.name] = step - self.begun
            if self.solution.outcome != "done":
                return self.solution
            self._snapshot(stage.name, step)
            if stage.action == "load":
                self.loading_speed = self._last(_SPEED)
        self._snapshot_if_requested(step)
        return self.solution

    def _run_stage(self, stage: Stage, step: int, end: int, kept: Checkpoint | None) -> int:
        amplitude_rate = 1.0 / ((end - self.begun) * self.dt) if stage.action == "load" else 0.0
        wrong = self.system.begin(stage, amplitude_rate, kept.memory if kept else None)
        if wrong:
            self._diverged(stage, step, wrong)
            return step
        if not kept:
            # Once with this stage's motion of the constraints, again at its end: the power of the
            # constraints jumps between stages, and its integral must not smear the jump.
            self._sample(step)
        ratio = self.config.solve.settle_ratio if stage.action == "settle" else None
        while step < end:
            # Before the snapshot: whoever goes on from here takes it.
            self._checkpoint_if_due(step)
            self._snapshot_if_requested(step)
            stop = self._next_event(step, end)
            step, wrong = self._chunked(step, stop)
            if wrong:
                self._diverged(stage, step, wrong)
                return step
            self._sample(step)
            wrong = breached(self.solution.history, self._spacing, self.config.solve)
            if wrong:
                self._diverged(stage, step, wrong)
                return step
            if ratio and self._last(_SPEED) < ratio * self.loading_speed:
                return step
        return end

    def _next_event(self, step: int, end: int) -> int:
        events = [end, (step // self.stride + 1) * self.stride]
        events += [r for r in self.requested if r > step]
        return min(events)

    def _chunked(self, step: int, stop: int) -> tuple[int, str]:
        while step < stop:
            begun = time.perf_counter()
            reached, wrong = self.system.advance(step, min(step + self._chunk, stop))
            if reached > step:
                per_step = max((time.perf_counter() - begun) / (reached - step), 1e-9)
                # The first call may have compiled: never trust one measurement by more than doubling.
                self._chunk = int(min(2 * self._chunk, max(1.0, CHUNK_SECONDS / per_step)))
            step = reached
            self.on_progress(step, self.total)
            if wrong:
                return step, wrong
            if step < stop:  # at the event itself its sample comes first
                self._checkpoint_if_due(step)
        return step, ""

    def _checkpoint_if_due(self, step: int) -> None:
        if self.keeper.due():
            self.keeper.save(self._checkpoint(step))

    def _checkpoint(self, step: int) -> Checkpoint:
        snapshots = self.solution.snapshots
        return Checkpoint(
            stage=self.stage,
            begun=self.begun,
            step=step,
            loading_speed=self.loading_speed,
            state=self.system.state,
            history=np.array(self.solution.history),
            stage_steps=np.array(list(self.solution.stage_steps.values()), np.int64),
            snapshot_labels=np.array([s.label for s in snapshots], dtype=str),
            snapshot_steps=np.array([s.step for s in snapshots], np.int64),
            snapshot_fields=np.array([s.fields for s in snapshots]).reshape(
                -1, len(FIELDS), self.system.state.shape[1]
            ),
            snapshot_energies=np.array([s.strain_energy for s in snapshots], float),
            snapshot_closures=np.array([s.closure_work for s in snapshots], float),
            good_step=self._good.step,
            good_energy=self._good.strain_energy,
            good_fields=self._good.fields,
            pairs=self.system.pairs,
            memory=self.system.memory(),
        )

    def _restore(self, kept: Checkpoint) -> None:
        self.system.state[:] = kept.state
        self.system.pairs = kept.pairs
        self.loading_speed = kept.loading_speed
        good_time = kept.good_step * self.dt
        self._good = Snapshot(LAST_GOOD, good_time, kept.good_step, kept.good_fields, kept.good_energy)
        names = (stage.name for stage in self.problem.stages)
        self.solution.stage_steps = dict(zip(names, kept.stage_steps.tolist(), strict=False))
        self.solution.history = [tuple(row) for row in kept.history]
        for label, step, values, energy, closure in zip(
            kept.snapshot_labels,
            kept.snapshot_steps.tolist(),
            kept.snapshot_fields,
            kept.snapshot_energies.tolist(),
            kept.snapshot_closures.tolist(),
            strict=True,
        ):
            kept_one = Snapshot(str(label), step * self.dt, step, values, energy, closure)
            self.solution.snapshots.append(kept_one)

    def _sample(self, step: int) -> None:
        x, y = self.system.state[:2, self.problem.tracked]
        body, i = self.problem.body, self.problem.tracked
        moved = (x - body.x[i], y - body.y[i])
        sums, seen = self.system.totals(), self.indicators.measure(self.system.state[:2])
        self.solution.history.append((step * self.dt, float(step), *moved, *sums, *seen))
        # A sample may come before the check that ends a run: what it saw by then is not good.
        if sums.largest_speed <= self._wave_speed and np.isfinite(sums.strain_energy):
            fields = self.system.fields()
            self._good = Snapshot(LAST_GOOD, step * self.dt, step, fields, sums.strain_energy)

    def _last(self, column: int) -> float:
        """Of the last sample, which is always taken before a snapshot and at a stage's end."""
        return self.solution.history[-1][column]

    def _snapshot_if_requested(self, step: int) -> None:
        if step in self.requested:
            self._snapshot(f"t={step * self.dt:.6g}", step)

    def _snapshot(self, label: str, step: int) -> None:
        self.solution.snapshots.append(
            Snapshot(
                label,
                step * self.dt,
                step,
                self.system.fields(),
                self._last(_ENERGY),
                self.system.closure_work(),
            )
        )

    def _diverged(self, stage: Stage, step: int, wrong: str) -> None:
        self.solution.outcome = "diverged"
        self.solution.snapshots.append(self._good)
        self.solution.message = (
            f"{wrong} at step {step} of {self.total} (t = {step * self.dt:.6g} s, stage {stage.name})"
        )
