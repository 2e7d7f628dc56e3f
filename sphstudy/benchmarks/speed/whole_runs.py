"""Whole runs as a user makes them: CPU time without compilation, from their records."""

import tempfile
from dataclasses import dataclass, replace

import numpy as np

from sphstudy.configuration.composition import Session
from sphstudy.running.one_run import computed
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store

RUNS = {
    "thesis, one period of the plate": (
        ("scene=plate", "method=thesis", "h=1.5", "n=9"),
        "thesis period",
    ),
    "tl, one period of the plate": (("scene=plate", "method=tl", "h=1.3", "n=9"), "tl period"),
    "tl, modes of the plate": (("scene=plate", "method=tl", "solve=modes", "h=1.3", "n=9"), "direct"),
    "tl, equilibrium of the plate": (
        ("scene=bending", "method=tl", "solve=equilibrium", "h=1.3", "n=9"),
        "direct",
    ),
}
"""Runs by name: their settings, and the bound that holds for them."""


@dataclass(frozen=True)
class WholeRun:
    """A timed run. seconds [rounds]: CPU time of building and solving, not of compiling or files."""

    label: str
    settings: str
    outcome: str
    seconds: np.ndarray
    bound: str

    @property
    def median(self) -> float:
        """Median of the rounds [s]."""
        return float(np.median(self.seconds))


def runs(hydra: Session, rounds: int) -> list[WholeRun]:
    """The runs in turns, after a first round that does not count, in which all is compiled."""
    points = [hydra.points(list(settings), sweep=False)[0][0] for settings, _ in RUNS.values()]
    seconds = np.full((len(RUNS), rounds + 1), np.nan)
    outcome = [""] * len(RUNS)
    with tempfile.TemporaryDirectory() as folder:
        store = Store(folder)
        store.prepare()
        for turn in range(rounds + 1):
            for k, point in enumerate(points):
                record = computed(point.config, store, replace(point.execution, checkpoint=1e6))
                outcome[k] = STATUS[int(record["status"])]
                seconds[k, turn] = record.get("cpu_seconds", np.nan)
    return [
        WholeRun(label, " ".join(settings), outcome[k], seconds[k, 1:], bound)
        for k, (label, (settings, bound)) in enumerate(RUNS.items())
    ]
