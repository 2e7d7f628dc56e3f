"""A process of its own that makes one step: `python -m sphstudy.benchmarks.speed.child key=value …`.

Prints JSON.

Seconds are CPU seconds since the process began: once Python and the program are loaded, and once the
first step is made. compile_seconds: of these, spent compiling. peak_memory: bytes.
"""

import json
import resource
import sys
import time
from pathlib import Path


def first_step(settings: list[str]) -> dict[str, float]:
    """What this process has spent until it has made one step."""
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
    """Of this process [byte]. Where there is /proc, from there: what getrusage tells begins with the peak
    of the process that started this one.
    """
    status = Path("/proc/self/status")
    if status.exists():
        line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return 1024.0 * int(line.split()[1])
    unit = 1 if sys.platform == "darwin" else 1024
    return float(unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


if __name__ == "__main__":
    print(json.dumps(first_step(sys.argv[1:])))
