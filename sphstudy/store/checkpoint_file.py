"""Checkpoints of a run in a sealed file beside its record: written by wall time, whole or not at all."""

import sys
import time
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from sphstudy.numerics.compile_timer import compiling_so_far
from sphstudy.numerics.solvers.checkpoint import Checkpoint
from sphstudy.store.atomic import replacing
from sphstudy.store.checksum import check_seal, seal


class CheckpointFile:
    """The checkpoint of a run.

    Parameters
    ----------
    path : Path
        Where it lies.
    interval : float
        Wall time between two checkpoints (s).

    Attributes
    ----------
    cpu_seconds, wall_seconds : float
        Time spent by earlier processes without compilation (s); 0 unless a checkpoint was loaded.
    """

    def __init__(self, path: Path, interval: float):
        self.path, self.interval = path, interval
        self.cpu_seconds = self.wall_seconds = 0.0
        self._wall, self._cpu = time.perf_counter(), time.process_time()
        self._compiling = compiling_so_far()
        self._last = time.monotonic()

    def load(self) -> Checkpoint | None:
        """The checkpoint in the file; None if there is none, or (with a line on stderr) it is damaged."""
        try:
            if not check_seal(self.path):
                raise ValueError("it has no digest")
            with open(self.path, "rb") as file:
                arrays = dict(np.load(file, allow_pickle=False))
            checkpoint = Checkpoint.from_arrays(arrays)
            self.cpu_seconds, self.wall_seconds = arrays["spent"].tolist()
            return checkpoint
        except FileNotFoundError:
            return None
        except (OSError, EOFError, ValueError, KeyError, zipfile.BadZipFile) as error:
            print(f"{self.path.name}: unreadable ({error}); the run starts anew", file=sys.stderr)
            return None

    def due(self) -> bool:
        """Whether the interval has passed."""
        return time.monotonic() - self._last >= self.interval

    def save(self, checkpoint: Checkpoint) -> None:
        """Writes the checkpoint, whole or not at all. A full disk costs the checkpoint, not the run."""
        try:
            self._write(checkpoint)
        except OSError as error:
            print(f"{self.path.name}: not written ({error}); the run goes on", file=sys.stderr)
        self._last = time.monotonic()

    def _write(self, checkpoint: Checkpoint) -> None:
        compiling = compiling_so_far()
        spent = (
            self.cpu_seconds + time.process_time() - self._cpu - (compiling[1] - self._compiling[1]),
            self.wall_seconds + time.perf_counter() - self._wall - (compiling[0] - self._compiling[0]),
        )
        arrays: Any = {"spent": np.array(spent), **checkpoint.arrays()}
        with replacing(self.path) as temporary, open(temporary, "wb") as file:
            np.savez(file, **arrays)
            file.close()
            seal(temporary, "")

    def remove(self) -> None:
        """Removes the file: the run has its record. A folder of that name stays."""
        with suppress(IsADirectoryError):
            self.path.unlink(missing_ok=True)
