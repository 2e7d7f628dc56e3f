"""What it costs to begin, each in a new process: loading, compiling into an empty cache, memory.

`python -m sphstudy.benchmarks.speed.start key=value …` is a process that makes one step and prints what
that cost as JSON.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

METHODS = {"thesis": ("method=thesis", "h=1.5"), "tl": ("method=tl", "h=1.3")}


@dataclass(frozen=True)
class Start:
    """A new process until its first step, in CPU seconds since it began.

    cold: with an empty cache of compiled code. load_seconds: until Python and the program are loaded;
    step_seconds: until the first step is made, compile_seconds of it compiling. peak_memory: bytes.
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
    """The plate at n = 9 once with an empty cache for each method, then with the cache that this left."""
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
    command = [sys.executable, "-m", "sphstudy.benchmarks.speed.start", *settings]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(settings)}: {done.stderr.strip().splitlines()[-1]}")
    return Start(method, n, cold, **json.loads(done.stdout))


def _first_step(settings: list[str]) -> dict[str, float]:
    """What this process has spent until it has made one step: fields of Start."""
    from sphstudy.benchmarks.speed.bodies import Case, made
    from sphstudy.configuration.composition import session
    from sphstudy.numerics.compile_timer import CompileTimer

    loaded = time.process_time()
    with session() as hydra, CompileTimer() as compiling:
        one = made(hydra, Case("first step", "start", tuple(settings)))
        _, wrong = one.system.advance(0, 1)
    if wrong:
        raise RuntimeError(wrong)
    return {
        "particles": one.particles,
        "load_seconds": loaded,
        "step_seconds": time.process_time(),
        "compile_seconds": compiling.cpu,
        "peak_memory": _peak_memory(),
    }


def _peak_memory() -> float:
    """Peak memory of this process [byte]: where there is /proc, from there, for what getrusage returns
    begins with the peak of the process that started this one.
    """
    status = Path("/proc/self/status")
    if status.exists():
        line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return 1024.0 * int(line.split()[1])
    unit = 1 if sys.platform == "darwin" else 1024
    return float(unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


if __name__ == "__main__":
    print(json.dumps(_first_step(sys.argv[1:])))
