"""Timing in turns: every round times each variant once, so that a machine's drift meets all alike."""

import time
from collections.abc import Callable, Sequence

import numpy as np

from sphstudy.numerics.solvers.system import System

Clock = Callable[[], float]


def interleaved(
    actions: Sequence[Callable[[], object]], rounds: int, clock: Clock = time.process_time
) -> np.ndarray:
    """Seconds [actions, rounds] that each action takes in each round, by the clock (s).

    Every round begins one action later than the one before, so that none always follows the same other.
    """
    seconds = np.full((len(actions), rounds), np.nan)
    for turn in range(rounds):
        for k in ((turn + later) % len(actions) for later in range(len(actions))):
            begun = clock()
            actions[k]()
            seconds[k, turn] = clock() - begun
    return seconds


class Stepper:
    """A system that takes the same number of steps whenever it is called, going on from where it is.

    steps: of one call, as many as fill a slice of time. wrong: why the system stopped, or "".
    """

    def __init__(self, system: System, slice_seconds: float, clock: Clock = time.process_time):
        """Takes a step first, which compiles and fills caches, then measures how long one takes."""
        self._system, self._done, self.wrong, self.steps = system, 0, "", 1
        self()
        spent = self._timed(clock)
        while spent < 0.1 * slice_seconds and not self.wrong:
            self.steps *= 2
            spent = self._timed(clock)
        if not self.wrong:
            self.steps = max(1, round(self.steps * slice_seconds / spent))

    def _timed(self, clock: Clock) -> float:
        begun = clock()
        self()
        return clock() - begun

    def __call__(self) -> None:
        if not self.wrong:
            _, self.wrong = self._system.advance(self._done, self._done + self.steps)
            self._done += self.steps
