"""What an explicit run needs to go on as if it had never stopped, as named arrays."""

from dataclasses import dataclass, field, fields
from typing import Any, Protocol

import numpy as np

_MEMORY = "memory_"


@dataclass
class Checkpoint:
    """A run between two steps. Restarted from it, a run is the uninterrupted one to the last bit.

    stage: index of the stage in progress; begun: step at which it began; step: steps taken in all.
    loading_speed: √Σv² at the end of loading (m/s), NaN before. state [rows, N] and memory: see
    solve.system. history [M, columns]. stage_steps: of the stages done. snapshot_…: those taken [K],
    fields [K, 8, N]. good_…: the last sample at which all was well. pairs: most pairs so far.
    """

    stage: int
    begun: int
    step: int
    loading_speed: float
    state: np.ndarray
    history: np.ndarray
    stage_steps: np.ndarray
    snapshot_labels: np.ndarray
    snapshot_steps: np.ndarray
    snapshot_fields: np.ndarray
    snapshot_energies: np.ndarray
    snapshot_closures: np.ndarray
    good_step: int
    good_energy: float
    good_fields: np.ndarray
    pairs: int
    memory: dict[str, np.ndarray] = field(default_factory=dict)

    def arrays(self) -> dict[str, np.ndarray]:
        """The fields as arrays, numbers as arrays without dimensions."""
        plain = {f.name: np.asarray(getattr(self, f.name)) for f in fields(self) if f.name != "memory"}
        return plain | {_MEMORY + name: np.asarray(values) for name, values in self.memory.items()}

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray]) -> "Checkpoint":
        """The inverse of `arrays`."""
        names = [f.name for f in fields(cls) if f.name != "memory"]
        values: dict[str, Any] = {
            name: arrays[name].item() if arrays[name].ndim == 0 else arrays[name] for name in names
        }
        memory = {
            name.removeprefix(_MEMORY): array
            for name, array in arrays.items()
            if name.startswith(_MEMORY)
        }
        return cls(**values, memory=memory)


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
