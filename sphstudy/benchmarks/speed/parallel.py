"""What a second core is worth: threads on one run, processes on a sweep, beside a control without memory.

Every measurement does the same work with one worker and with two, in turns, in wall time. The control
is arithmetic that needs no memory, so that its ratio says how much of a second core there was.
"""

import hashlib
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numba
import numpy as np

from sphstudy.benchmarks.speed.bodies import Case, made
from sphstudy.benchmarks.speed.interleave import Stepper, interleaved
from sphstudy.configuration.composition import Session
from sphstudy.running.one_run import run_job
from sphstudy.running.pool import Pool
from sphstudy.store.job import Job
from sphstudy.store.store import Store

CONTROL_SECONDS = 1.0
"""Wall time of the control beside sweeps, on one core (s)."""


@dataclass(frozen=True)
class Scaling:
    """seconds [2, rounds]: wall time of the same work with one worker and with two.

    control [2, rounds]: of the control, in the same rounds.
    """

    label: str
    workers: str
    seconds: np.ndarray
    control: np.ndarray
    bound: str

    @property
    def speedup(self) -> float:
        """Median over the rounds of the time with one worker over that with two."""
        return float(np.median(self.seconds[0] / self.seconds[1]))

    @property
    def control_speedup(self) -> float:
        """That ratio for the control: 2 where two cores were free."""
        return float(np.median(self.control[0] / self.control[1]))


class Control:
    """Two equal portions of arithmetic in registers, together about `seconds` on one core."""

    def __init__(self, seconds: float):
        self._iterations = 20_000
        begun = time.perf_counter()
        self._portion()
        self._iterations = max(1, round(0.5 * self._iterations * seconds / (time.perf_counter() - begun)))

    def _portion(self, _: int = 0) -> None:
        # Key derivation hashes one block over and over, and lets other threads run meanwhile.
        hashlib.pbkdf2_hmac("sha256", b"arithmetic", b"no memory", self._iterations)

    def one(self) -> None:
        """Both portions, one after the other."""
        for _ in range(2):
            self._portion()

    def two(self) -> None:
        """Both portions at once, in two threads."""
        with ThreadPoolExecutor(2) as workers:
            list(workers.map(self._portion, range(2)))


def compared(
    label: str,
    workers: str,
    one: Callable[[], object],
    two: Callable[[], object],
    control: Control,
    rounds: int,
    bound: str,
) -> Scaling:
    """The same work with one worker and with two, the control in between."""
    taken = interleaved((one, control.one, two, control.two), rounds, time.perf_counter)
    return Scaling(label, workers, taken[[0, 2]], taken[[1, 3]], bound)


def threads(hydra: Session, n: int, rounds: int, slice_seconds: float) -> tuple[list[Scaling], str]:
    """One and two threads on a plate with n rows; and a remark where there is one core only."""
    if numba.config.NUMBA_NUM_THREADS < 2:  # type: ignore[attr-defined]
        return [], "threads: not measured, there is one core"
    numba.set_num_threads(2)
    control, found = Control(slice_seconds), []
    for method, h in (("thesis", 1.5), ("tl", 1.3)):
        settings = ("scene=plate", f"n={n}", f"method={method}", f"h={h}")
        pair = [
            Stepper(
                made(hydra, Case(f"{method} on {count}", "threads", settings), count).system,
                slice_seconds,
                time.perf_counter,
            )
            for count in (1, 2)
        ]
        # Steps as many as one thread takes in a slice: both do the same work.
        pair[1].steps = pair[0].steps
        label = f"{method}, plate n={n}"
        found.append(compared(label, "threads", pair[0], pair[1], control, rounds, "two threads"))
    return found, ""


def _failed(job, outcome: str, why: str) -> None:
    raise RuntimeError(f"a run was {outcome}: {why}")


def processes(hydra: Session, settings: tuple[str, ...], jobs: int, rounds: int) -> list[Scaling]:
    """A sweep of `jobs` equal runs in one process and in two, launched as every sweep is.

    The runs differ in their seed, which these scenes do not use, so that each leaves its own record.
    """
    with tempfile.TemporaryDirectory() as folder:
        seeds = f"seed={','.join(map(str, range(jobs)))}"
        points, _ = hydra.points([*settings, seeds, f"results={folder}"], sweep=True)
        store = Store(folder)
        store.prepare()

        def sweep(count: int, first: int = jobs) -> None:
            Pool(count).run(run_job, [Job.of(p, store) for p in points[:first]], None, _failed)

        sweep(1, 1)  # compiled once, which does not count
        control = Control(CONTROL_SECONDS)
        label = f"{jobs} runs, {' '.join(settings)}"
        both = compared(
            label, "processes", lambda: sweep(1), lambda: sweep(2), control, rounds, "two processes"
        )
    return [both]
