"""A process of its own that makes one step: `python -m sphstudy.speed.child key=value …` prints JSON.

Seconds are CPU seconds since the process began: once Python and the program are loaded, and once the
first step is made. compile_seconds: of these, spent compiling. peak_memory: bytes.
"""

import json
import resource
import sys
import time


def first_step(settings: list[str]) -> dict[str, float]:
    """What this process has spent until it has made one step."""
    from sphstudy.compile_timer import CompileTimer
    from sphstudy.composition import session
    from sphstudy.speed.bodies import Case, made

    loaded = time.process_time()
    with session() as hydra, CompileTimer() as compiling:
        one = made(hydra, Case("first step", "start", tuple(settings)))
        _, wrong = one.system.advance(0, 1)
    if wrong:
        raise RuntimeError(wrong)
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return {
        "particles": one.particles,
        "load_seconds": loaded,
        "step_seconds": time.process_time(),
        "compile_seconds": compiling.cpu,
        # Linux counts in KiB, macOS in bytes.
        "peak_memory": usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024),
    }


if __name__ == "__main__":
    print(json.dumps(first_step(sys.argv[1:])))
