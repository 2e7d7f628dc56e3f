"""Gets runs done by a launcher, whatever happens to its workers and whoever else computes them."""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

from sphstudy.configuration.composition import Launcher, Point
from sphstudy.running.one_run import compute, give_up, run_job
from sphstudy.running.slurm.settings import settings_of
from sphstudy.store.job import Job
from sphstudy.store.lock import is_alive
from sphstudy.store.store import Store

PATIENCE = 1.0
"""Seconds between two looks at runs that another process computes."""


def workers_of(launcher: Launcher, points: list[Point]) -> int:
    """How many runs go on at once: one a core of this machine, or fewer if runs have several threads.

    On a cluster, as many as an array may have at work. Raises ConfigurationError if jobs cannot be
    submitted from here.
    """
    if launcher.name == "slurm":
        return settings_of(launcher.settings).array_parallelism
    jobs, cores = launcher.settings.get("n_jobs"), os.cpu_count() or 1
    threads = max((point.execution.threads for point in points), default=1)
    most = cores if jobs == -1 else jobs or cores // threads
    return 1 if launcher.name == "basic" else max(1, most)


class Workers(Protocol):
    """What runs jobs in other processes: here (pool.Pool), or on a cluster (slurm.jobs.Slurm)."""

    def run(
        self,
        task: Callable[[Any], Any],
        jobs: list[Any],
        time_limit: float | None,
        lost: Callable[[Any, str, str], None],
    ) -> None:
        """Calls task(job) for each job, and lost(job, outcome, reason) for each that is not finished."""

    def stop(self) -> None:
        """Ends all jobs that are at work."""


class Launching:
    """Points that are to be run, and what runs them.

    Parameters
    ----------
    store : Store
        Where records go.
    points : list of Point
        Those to run, the longest first.
    launcher : Launcher
        What runs them; its settings are checked here (ConfigurationError).
    """

    def __init__(self, store: Store, points: list[Point], launcher: Launcher):
        self._store, self._points, self._launcher = store, points, launcher
        self._workers = workers_of(launcher, points)
        self._unstored: set[Path] = set()

    def run(self) -> None:
        """Works until every run has a record, or another process is computing it.

        A worker that is killed costs its own run, which then has failed. A launcher that ends before its
        runs are done is started again, as long as that gets any of them done.
        """
        pending = self._points
        while pending:
            jobs = self._launch(pending)
            left = [p for p, job in zip(pending, jobs, strict=True) if self._is_undone(p, job)]
            if len(left) == len(pending):
                for point in left:
                    self._give_up(point, "failed", "its launcher ended without it")
                return
            if left:
                print(f"{len(left)} runs were left undone: going on with them", file=sys.stderr)
            pending = left
        self.wait_for(self._points)

    def wait_for(self, points: list[Point]) -> None:
        """Waits until runs that other processes compute are done; computes them if those are lost."""
        waiting = self._claimed(points)
        if waiting:
            print(f"{len(waiting)} runs are being computed elsewhere: waiting for them", file=sys.stderr)
        while waiting:
            time.sleep(PATIENCE)
            waiting = self._claimed(waiting)
        left = [
            p
            for p in points
            if self._store.record_path(p.config) not in self._unstored
            and self._store.status(p.config) in ("missing", "interrupted")
        ]
        if left:
            self._launch(left)

    def _claimed(self, points: list[Point]) -> list[Point]:
        """Those that a living process computes."""
        return [p for p in points if is_alive(self._store.claim_path(p.config))]

    def _is_undone(self, point: Point, job: Job) -> bool:
        """Whether a run was launched and has neither a new record nor a process that computes it."""
        return (
            self._store.stamp(point.config) == job.known
            and not is_alive(self._store.claim_path(point.config))
            and self._store.record_path(point.config) not in self._unstored
        )

    def _launch(self, points: list[Point]) -> list[Job]:
        """Runs the points; returns the job of each."""
        jobs = [Job.of(point, self._store) for point in points]
        with _terminated_as_interrupted():
            if self._launcher.name == "slurm":
                from sphstudy.running.slurm.jobs import Slurm

                self._by(Slurm(self._launcher.settings, self._store.folder), points, jobs)
            elif self._launcher.name == "basic" or len(points) == 1:
                # A single run stays in this process: starting another takes longer than many a run.
                for point, job in zip(points, jobs, strict=True):
                    self._compute(point, job)
            else:
                from sphstudy.running.pool import Pool

                self._by(Pool(self._workers), points, jobs)
        return jobs

    def _by(self, workers: Workers, points: list[Point], jobs: list[Job]) -> None:
        point_of = {id(job): point for job, point in zip(jobs, points, strict=True)}
        limits = [job.execution.time_limit for job in jobs]
        longest = None if None in limits else max(limit for limit in limits if limit is not None)
        try:
            workers.run(run_job, jobs, longest, lambda job, *why: self._give_up(point_of[id(job)], *why))
        except BaseException:
            workers.stop()
            raise

    def _compute(self, point: Point, job: Job) -> None:
        try:
            compute(point.config, self._store, point.execution, job.known)
        except OSError as error:
            self._give_up(point, "interrupted", str(error))

    def _give_up(self, point: Point, outcome: str, why: str) -> None:
        """Writes the record of a run that left none. If the disk does not take it, the run stays without,
        so that it is done again as soon as there is room.
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
def _terminated_as_interrupted() -> Iterator[None]:
    """SIGTERM ends the block as Ctrl-C does, so that workers and jobs of a cluster are ended too."""
    if threading.current_thread() is not threading.main_thread():
        yield  # Signals are the main thread's.
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
