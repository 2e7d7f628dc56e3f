"""Live display of a sweep: points done, runs with their steps, time left; plain lines in a pipe."""

import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table

from sphstudy.configuration.run_settings import RunConfig
from sphstudy.store.lock import Holder, holder
from sphstudy.store.store import Store
from sphstudy.text import duration

_INTERVAL = 0.5
_SILENCE = 30.0


@dataclass
class _Follower:
    """One run, followed by the files that it leaves, whichever process computes it."""

    config: RunConfig
    cost: float
    store: Store

    def __post_init__(self) -> None:
        self.record = self.store.record_path(self.config)
        self.claim = self.store.claim_path(self.config)
        self._before = self._stamp()
        self.finished = False
        self.fraction = 0.0
        self.note: Holder | None = None

    def _stamp(self) -> int:
        return self.record.stat().st_mtime_ns if self.record.exists() else 0

    def leaves(self, files: set[str]) -> bool:
        """Whether the run has left any of these."""
        return self.record.name in files or self.claim.name in files

    def look(self) -> bool:
        """Looks at the files; True if the run has just finished."""
        self.note = holder(self.claim)
        if self.note and self.note.steps:
            self.fraction = self.note.step / self.note.steps
        if not self.finished and self._stamp() != self._before:
            self.finished, self.fraction = True, 1.0
            return True
        return False

    def outcome(self) -> str:
        """Status and CPU time of the finished run."""
        summary = self.store.summary(self.config)
        if summary is None:
            return "unreadable"
        seconds = summary.numbers.get("cpu_seconds")
        cpu = f", {seconds:.1f} s of CPU" if seconds is not None else ""
        message = summary.attributes["message"]
        return f"{summary.status}{cpu}" + (f" ({message})" if message else "")


class _Board:
    """All runs of a sweep and what is to be said about them."""

    def __init__(self, runs: list[tuple[RunConfig, float]], store: Store, reused: int):
        self.followers = [_Follower(config, cost, store) for config, cost in runs]
        self.folder, self.reused = store.runs, reused
        self.cost = sum(cost for _, cost in runs)
        self.started = time.monotonic()

    def news(self) -> Iterator[str]:
        """Looks at all runs; a plain line for each that has just finished."""
        # The folder once, not every file that might be there: twice a second, and there may be 20 000.
        there: set[str] = set()
        with suppress(OSError):
            there.update(os.listdir(self.folder))
        for follower in self.followers:
            if follower.finished or not (follower.note or follower.leaves(there)):
                continue
            if follower.look():
                yield self.line(follower)

    @property
    def finished(self) -> int:
        return sum(f.finished for f in self.followers)

    def time_left(self) -> str:
        """From the share of the predicted cost that is done by now."""
        done = sum(f.cost * f.fraction for f in self.followers) / self.cost
        elapsed = time.monotonic() - self.started
        if done < 0.01 or elapsed < 2.0:
            return "time left unknown yet"
        return f"about {duration(elapsed * (1.0 - done) / done, 2)} left"

    def headline(self) -> str:
        """One line: how many are done, and how long the rest will take."""
        kept = f", {self.reused} kept from before" if self.reused else ""
        return f"{self.finished} of {len(self.followers)} runs done{kept}, {self.time_left()}"

    def running(self) -> str:
        """The runs in progress, each with its share done."""
        active = [f for f in self.followers if f.note and not f.finished]
        return "running: " + ", ".join(f"{f.config.label} {f.fraction:.0%}" for f in active)

    def line(self, follower: _Follower) -> str:
        """A plain line for a run that has finished."""
        left = f", {self.time_left()}" if self.finished < len(self.followers) else ""
        count = f"[{self.finished}/{len(self.followers)}]"
        return f"{count} {follower.config.label}: {follower.outcome()}{left}"

    def picture(self) -> Group:
        """The headline, and a bar for every run in progress."""
        rows = Table.grid(padding=(0, 2))
        for follower in self.followers:
            if follower.note and not follower.finished:
                note = follower.note
                bar = ProgressBar(total=max(note.steps, 1), completed=note.step, width=30)
                state = (
                    f"step {note.step:,} of {note.steps:,}"
                    if note.steps
                    else "starting (the first run compiles)"
                )
                rows.add_row(follower.config.label, bar, state)
        return Group(self.headline(), rows)


@contextmanager
def display(runs: list[tuple[RunConfig, float]], store: Store, reused: int) -> Iterator[None]:
    """Shows the progress of the runs (configuration, predicted cost) while the block works."""
    console = Console(stderr=True)
    board = _Board(runs, store, reused)
    stop = threading.Event()
    follow = _follow_live if console.is_terminal else _follow_plainly
    thread = threading.Thread(target=follow, args=(board, console, stop), daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def _follow_plainly(board: _Board, console: Console, stop: threading.Event) -> None:
    console.print(board.headline(), highlight=False, soft_wrap=True)
    ended, spoke = False, time.monotonic()
    while not ended:
        ended = stop.wait(_INTERVAL)
        lines = list(board.news())
        if not (lines or ended) and time.monotonic() - spoke > _SILENCE:
            lines = [f"{board.headline()}; {board.running()}"]
        for line in lines:
            console.print(line, highlight=False, markup=False, soft_wrap=True)
            spoke = time.monotonic()


def _follow_live(board: _Board, console: Console, stop: threading.Event) -> None:
    with Live(board.picture(), console=console, transient=True, auto_refresh=False) as live:
        ended = False
        while not ended:
            ended = stop.wait(_INTERVAL)
            for line in board.news():
                live.console.print(line, highlight=False, markup=False)
            live.update(board.picture(), refresh=True)
