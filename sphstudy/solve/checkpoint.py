"""What an explicit run needs to go on as if it had never stopped, as named arrays."""

from dataclasses import dataclass, fields
from typing import Any, Protocol

import numpy as np


@dataclass
class Checkpoint:
    """A run between two steps. Restarted from it, a run is the uninterrupted one to the last bit.

    stage: index of the stage in progress; begun: step at which it began; step: steps taken in all.
    loading_speed: √Σv² at the end of loading (m/s), NaN before. state [8, N]. list_x, list_y [N] (m) and
    list_skin (m): what the neighbour list in force was built from. history [M, columns]. stage_steps: of
    the stages done. snapshot_labels, _steps [K], _states [K, 8, N]. pairs: most pairs so far.
    """

    stage: int
    begun: int
    step: int
    loading_speed: float
    state: np.ndarray
    list_x: np.ndarray
    list_y: np.ndarray
    list_skin: float
    history: np.ndarray
    stage_steps: np.ndarray
    snapshot_labels: np.ndarray
    snapshot_steps: np.ndarray
    snapshot_states: np.ndarray
    pairs: int

    def arrays(self) -> dict[str, np.ndarray]:
        """The fields as arrays, numbers as arrays without dimensions."""
        return {field.name: np.asarray(getattr(self, field.name)) for field in fields(self)}

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray]) -> "Checkpoint":
        """The inverse of `arrays`."""
        named = ((field.name, arrays[field.name]) for field in fields(cls))
        values: dict[str, Any] = {name: v.item() if v.ndim == 0 else v for name, v in named}
        return cls(**values)


class Keeper(Protocol):
    """Where checkpoints go, and when."""

    def load(self) -> Checkpoint | None:
        """The last checkpoint of this run, if there is one."""

    def due(self) -> bool:
        """Whether it is time for another."""

    def save(self, checkpoint: Checkpoint) -> None:
        """Keeps the checkpoint in place of the one before."""


class NoKeeper:
    """Keeps nothing."""

    def load(self) -> Checkpoint | None:
        """Nothing was kept."""
        return None

    def due(self) -> bool:
        """It never is."""
        return False

    def save(self, checkpoint: Checkpoint) -> None:
        """Never called, since none is ever due."""
