"""What it costs to begin, each in a new process: loading, compiling into an empty cache, memory."""

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass

METHODS = {"thesis": ("method=thesis", "h=1.5"), "tl": ("method=tl", "h=1.3")}


@dataclass(frozen=True)
class Start:
    """A new process until its first step, in CPU seconds. cold: with an empty cache of compiled code.

    peak_memory: bytes; see speed.child.
    """

    method: str
    n: int
    cold: bool
    particles: int
    load_seconds: float
    step_seconds: float
    compile_seconds: float
    peak_memory: float

    @property
    def peak_megabytes(self) -> float:
        """Peak memory of the process [1e6 bytes]."""
        return 1e-6 * self.peak_memory


def from_empty_cache(repeats: int) -> list[Start]:
    """The plate at n = 9 with an empty cache, once a method, then with what that has left, in turns."""
    with tempfile.TemporaryDirectory() as folder:
        cold = [_start(method, 9, True, f"{folder}/{method}") for method in METHODS]
        warm = [
            _start(method, 9, False, f"{folder}/{method}") for _ in range(repeats) for method in METHODS
        ]
    return [*cold, *warm]


def growing(rows: tuple[int, ...]) -> list[Start]:
    """Plates of these rows, from the usual cache: for their memory."""
    return [_start(method, n, False, "") for n in rows for method in METHODS]


def _start(method: str, n: int, cold: bool, cache: str) -> Start:
    """Raises RuntimeError with the process's last words if it fails."""
    environment = os.environ | ({"NUMBA_CACHE_DIR": cache} if cache else {})
    settings = ("scene=plate", f"n={n}", *METHODS[method])
    command = [sys.executable, "-m", "sphstudy.benchmarks.speed.child", *settings]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(settings)}: {done.stderr.strip().splitlines()[-1]}")
    return Start(method, n, cold, **json.loads(done.stdout))
