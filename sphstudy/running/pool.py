"""Runs in processes of this machine, one worker a slot: a worker that dies costs its own run only.

loky ends a whole pool when one of its workers is killed, and does not say which run it had. So every slot
has a pool of one.
"""

import os
import queue
import re
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as Overdue
from multiprocessing import resource_tracker
from typing import Any

from joblib.externals.loky.process_executor import BrokenProcessPool, ProcessPoolExecutor

GRACE = 120.0
"""Seconds beyond its time limit after which a run that has not ended itself is ended: a start, with
compilation, does not count against the limit.
"""


class Pool:
    """So many workers at most, each with its share of the cores."""

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
        """Calls task(job) for each job in some worker, in the order given, and waits for all.

        A worker that dies, or a job that takes longer than `time_limit` (s) and some grace, is reported,
        lost(job, "failed" or "timeout", why), and the others go on. What a task raises is lost too, as
        "interrupted" if it is an OSError: the disk did not take its record.
        """
        waiting: queue.SimpleQueue[Any] = queue.SimpleQueue()
        for job in jobs:
            waiting.put(job)
        deadline = None if time_limit is None else time_limit + GRACE
        # loky starts it with the first worker, and Python's lets SIGINT through again where it starts it.
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
        """Ends all workers at once."""
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
            # None that is started after the others were ended.
            if self._stopped.is_set():
                return
            if slot not in self._executors:
                share = max(1, (os.cpu_count() or 1) // self.workers)
                self._executors[slot] = ProcessPoolExecutor(
                    1, None, env=thread_settings(share), initializer=_end_with, initargs=(os.getpid(),)
                )
            future: Future = self._executors[slot].submit(task, job)
        try:
            future.result(deadline)
        except Exception as error:
            if isinstance(error, Overdue | BrokenProcessPool) and (
                executor := self._executors.pop(slot, None)
            ):
                executor.shutdown(wait=False, kill_workers=True)
            if not self._stopped.is_set():
                lost(job, *_why(error, deadline))


def thread_settings(count: int) -> dict[str, str]:
    """Environment of a process that may use so many threads."""
    names = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    return dict.fromkeys(names, str(count))


def _end_with(parent: int) -> None:
    """Ends this worker once its parent is gone: loky's wait for ever for one that was killed."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(1.0)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _why(error: Exception, deadline: float | None) -> tuple[str, str]:
    """How a run ended, and why: of a dead worker with the exit code that loky names."""
    if isinstance(error, BrokenProcessPool):
        code = re.search(r"SIG[A-Z]+\(-\d+\)|EXIT\(\d+\)", str(error))
        told = f" ({code.group()})" if code else ""
        return "failed", f"its process was ended from outside, by a signal or for want of memory{told}"
    if isinstance(error, Overdue):
        return "timeout", f"ended after {deadline:g} s: it did not end itself"
    if isinstance(error, OSError):
        return "interrupted", str(error)
    return "failed", f"{type(error).__name__}: {error}"
