"""Runs in processes of this machine: a worker that dies costs its own run only.

loky ends a whole pool when one of its workers is killed, and does not say which run it had. Each slot
therefore has a pool of one worker.
"""

import os
import queue
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing import resource_tracker
from typing import Any

from loky import BrokenProcessPool, ProcessPoolExecutor

from sphstudy.configuration.execution import GRACE, thread_settings


class Pool:
    """Worker processes, at most `workers` at once, each with its share of the cores."""

    def __init__(self, workers: int):
        self.workers = workers
        self._executors: dict[int, ProcessPoolExecutor] = {}
        self._stopped = threading.Event()
        self._starting = threading.Lock()

    def run(
        self,
        task: Callable[[Any], Any],
        jobs: list[Any],
        time_limit: float | None,
        lost: Callable[[Any, str, str], None],
    ) -> None:
        """Calls task(job) for each job in a worker, in the order given, and waits for all.

        Parameters
        ----------
        task : callable
            A function of a module, which workers import.
        jobs : list
            What it takes; each can be pickled.
        time_limit : float or None
            Wall time of a run (s): a worker that takes GRACE longer is killed.
        lost : callable
            Called as lost(job, outcome, reason) for a job that its worker did not finish: "failed" if the
            worker died or the task raised, "timeout", or "interrupted" after an OSError of the task (the
            disk did not take its record). The other jobs go on.
        """
        waiting: queue.SimpleQueue[Any] = queue.SimpleQueue()
        for job in jobs:
            waiting.put(job)
        deadline = None if time_limit is None else time_limit + GRACE
        # Python's tracker lets SIGINT through again in the thread that starts it: not in one of a slot.
        resource_tracker.ensure_running()
        slots = [
            threading.Thread(target=self._serve, args=(slot, task, waiting, deadline, lost), daemon=True)
            for slot in range(min(self.workers, len(jobs)))
        ]
        for slot in slots:
            slot.start()
        for slot in slots:
            # In short waits, or no signal would reach the thread that waits.
            while slot.is_alive():
                slot.join(0.2)

    def stop(self) -> None:
        """Kills all workers at once; none of their jobs counts as lost."""
        with self._starting:
            self._stopped.set()
        for executor in list(self._executors.values()):
            executor.shutdown(wait=False, kill_workers=True)

    def _serve(self, slot, task, waiting, deadline, lost) -> None:
        # Workers inherit this: Ctrl-C in a terminal reaches them too, but the parent ends them.
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        while not self._stopped.is_set():
            try:
                job = waiting.get_nowait()
            except queue.Empty:
                break
            self._do(slot, task, job, deadline, lost)
        if executor := self._executors.pop(slot, None):
            executor.shutdown(wait=True)

    def _do(self, slot, task, job, deadline, lost) -> None:
        with self._starting:
            # No worker may start after `stop` has killed the others.
            if self._stopped.is_set():
                return
            if slot not in self._executors:
                share = max(1, (os.cpu_count() or 1) // self.workers)
                self._executors[slot] = ProcessPoolExecutor(
                    1, env=thread_settings(share), initializer=_end_with, initargs=(os.getpid(),)
                )
            future: Future = self._executors[slot].submit(task, job)
        try:
            future.result(deadline)
        except Exception as error:
            # What a task raises may be a TimeoutError too.
            overdue = not future.done()
            broken = overdue or isinstance(error, BrokenProcessPool)
            if broken and (executor := self._executors.pop(slot, None)):
                executor.shutdown(wait=False, kill_workers=True)
            if self._stopped.is_set():
                return
            if overdue:
                lost(job, "timeout", f"ended after {deadline:g} s: it did not end itself")
            else:
                lost(job, *_why(error))


def _end_with(parent: int) -> None:
    """Ends this worker once its parent is gone: loky's wait for ever for one that was killed."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(1.0)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _why(error: Exception) -> tuple[str, str]:
    """Outcome and reason of a job that was lost; of a dead worker also what loky says of its end."""
    if isinstance(error, BrokenProcessPool):
        codes = [line for line in str(error).splitlines() if "exit codes" in line]
        return "failed", ". ".join(
            ["its process was ended from outside, by a signal or for want of memory", *codes]
        )
    if isinstance(error, OSError):
        return "interrupted", str(error)
    return "failed", f"{type(error).__name__}: {error}"
