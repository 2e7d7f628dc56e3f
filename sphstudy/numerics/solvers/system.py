"""What explicit stepping needs of a discretised problem, whatever its formulation."""

from typing import Protocol

import numpy as np

from sphstudy.model.problem import Stage
from sphstudy.numerics.sph.invariants import Invariants


class System(Protocol):
    """A problem as it is stepped: it owns the state and whatever else one step hands to the next.

    state [rows, N]: whole, so that a run can go on from it and `memory`; its first rows are x, y and the
    velocity's. pairs: most pairs so far.
    """

    state: np.ndarray
    pairs: int

    def begin(self, stage: Stage, amplitude_rate: float, kept: dict[str, np.ndarray] | None) -> str:
        """Makes ready for a stage in which prescribed freedoms move with target · amplitude_rate (1/s).

        `kept`: what `memory` returned, if the stage goes on from a checkpoint. Returns what is wrong.
        """

    def advance(self, begin: int, end: int) -> tuple[int, str]:
        """Steps from number `begin` to `end`; returns steps taken in all, and what is wrong, or ""."""

    def totals(self) -> Invariants:
        """Invariants of the state."""

    def fields(self) -> np.ndarray:
        """The body as a record keeps it [8, N], rows solution.FIELDS; a copy."""

    def closure_work(self) -> float:
        """See solution.Snapshot."""

    def memory(self) -> dict[str, np.ndarray]:
        """What the state does not hold and a restart needs."""
