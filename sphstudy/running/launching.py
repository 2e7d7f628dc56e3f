"""Gets runs done by a launcher, whatever happens to its workers and whoever else is at it."""

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol

from sphstudy.configuration.composition import Launcher, Point
from sphstudy.running.one_run import compute, give_up, job
from sphstudy.running.plan import Planned
from sphstudy.store.lock import is_alive
from sphstudy.store.store import Store

PATIENCE = 1.0
"""Seconds between two looks at runs that somebody else computes."""


def workers_of(launcher: Launcher, points: list[Point]) -> int:
    """How many runs go on at once: one a core of this machine, or fewer if runs have several threads.

    On a cluster, as many as an array may have at work.
    """
    jobs, cores = launcher.settings.get("n_jobs"), os.cpu_count() or 1
    threads = max((point.execution.threads for point in points), default=1)
    most = cores if jobs == -1 else jobs or cores // threads
    if launcher.name == "slurm":
        return int(launcher.settings["array_parallelism"])
    return 1 if launcher.name == "basic" else max(1, most)


class Workers(Protocol):
    """What runs jobs in other processes, here or elsewhere (see pool.Pool)."""

    def run(
        self,
        task: Callable[[Any], Any],
        jobs: list[Any],
        time_limit: float | None,
        lost: Callable[[Any, str, str], None],
    ) -> None:
        """Calls task(job) for each job, and lost(job, outcome, why) for each that it cannot finish."""

    def stop(self) -> None:
        """Ends all that are at work."""


class Launching:
    """The runs that are to be done, and how."""

    def __init__(self, store: Store, pending: list[Planned], launcher: Launcher):
        self._store, self._pending, self._launcher = store, pending, launcher
        self._workers = workers_of(launcher, [p.point for p in pending])
        self._unstored: set[Path] = set()

    def run(self) -> None:
        """Until every run has a record, or another process is computing it.

        A worker that is killed costs its own run, which is then failed. A launcher that comes to an end
        before its runs are done is started again, as long as that gets any of them done.
        """
        pending = self._stamped(self._pending)
        while pending:
            with _interrupted_cleanly():
                self._launch(pending)
            left = [p for p in pending if self._store.stamp(p.point.config) == p.point.execution.known]
            left = [p for p in left if not is_alive(self._store.claim_path(p.point.config))]
            left = [p for p in left if self._store.record_path(p.point.config) not in self._unstored]
            if len(left) == len(pending):
                for p in left:
                    self._give_up(p.point, "failed", "its launcher ended without it")
                return
            if left:
                print(f"{len(left)} runs were left undone: going on with them", file=sys.stderr)
            pending = left
        self.wait_for(self._pending)

    def wait_for(self, others: list[Planned]) -> None:
        """Waits until runs that other processes compute are done; computes them if those are lost."""
        waiting, said = list(others), False
        while waiting:
            waiting = [p for p in waiting if is_alive(self._store.claim_path(p.point.config))]
            if waiting and not said:
                print(
                    f"{len(waiting)} runs are being computed elsewhere: waiting for them", file=sys.stderr
                )
                said = True
            if waiting:
                time.sleep(PATIENCE)
        left = [
            p
            for p in others
            if self._store.record_path(p.point.config) not in self._unstored
            and self._store.status(p.point.config) in ("missing", "interrupted")
        ]
        if left:
            with _interrupted_cleanly():
                self._launch(self._stamped(left))

    def _stamped(self, pending: list[Planned]) -> list[Planned]:
        """With what each record is known by now: one that changes meanwhile is somebody else's work."""
        found = []
        for p in pending:
            execution = replace(p.point.execution, known=self._store.stamp(p.point.config))
            found.append(replace(p, point=replace(p.point, execution=execution)))
        return found

    def _launch(self, pending: list[Planned]) -> None:
        if self._launcher.name == "slurm":
            from sphstudy.running.slurm.jobs import Slurm

            self._by(Slurm(self._launcher.settings, self._store.folder), pending)
        elif self._launcher.name == "basic" or len(pending) == 1:
            # A single run stays in this process: starting another takes longer than many a run.
            for p in pending:
                self._compute(p.point)
        else:
            from sphstudy.running.pool import Pool

            self._by(Pool(self._workers), pending)

    def _by(self, workers: Workers, pending: list[Planned]) -> None:
        jobs = [(p.point.config.as_dict(), str(self._store.folder), p.point.execution) for p in pending]
        points = {id(one): p.point for one, p in zip(jobs, pending, strict=True)}
        limits = [p.point.execution.time_limit for p in pending]
        longest = None if None in limits else max(limit for limit in limits if limit is not None)
        try:
            workers.run(job, jobs, longest, lambda one, *why: self._give_up(points[id(one)], *why))
        except BaseException:
            workers.stop()
            raise

    def _compute(self, point: Point) -> None:
        try:
            compute(point.config, self._store, point.execution)
        except OSError as error:
            self._give_up(point, "interrupted", str(error))

    def _give_up(self, point: Point, outcome: str, why: str) -> None:
        """Writes what became of a run that has no record. One whose record the disk does not take stays
        without, so that it is done again as soon as there is room.
        """
        try:
            if outcome != "interrupted":
                give_up(point.config, self._store, outcome, why)
                return
        except OSError as error:
            why = f"{why}; {error}"
        self._unstored.add(self._store.record_path(point.config))
        print(f"{point.config.label}: its record could not be written ({why})", file=sys.stderr)


@contextmanager
def _interrupted_cleanly() -> Iterator[None]:
    """A polite kill ends the block as Ctrl-C does: workers are taken along."""

    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
