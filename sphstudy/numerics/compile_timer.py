"""Time spent compiling, told apart from time spent running."""

import time

from numba.core import event


class _Listener(event.Listener):
    """Adds up the outermost compilation events of this process, wall and CPU time."""

    def __init__(self) -> None:
        self.wall = self.cpu = 0.0
        self._depth = 0
        self._began = (0.0, 0.0)

    def on_start(self, event) -> None:
        if self._depth == 0:
            self._began = (time.perf_counter(), time.process_time())
        self._depth += 1

    def on_end(self, event) -> None:
        self._depth -= 1
        if self._depth == 0:
            self.wall += time.perf_counter() - self._began[0]
            self.cpu += time.process_time() - self._began[1]


_LISTENER = _Listener()
event.register("numba:compile", _LISTENER)


def compiling_so_far() -> tuple[float, float]:
    """Seconds that this process has spent compiling, of wall and of CPU time."""
    return _LISTENER.wall, _LISTENER.cpu


class CompileTimer:
    """Seconds spent compiling inside a `with` block, 0 from a warm cache: of wall and of CPU time."""

    wall = cpu = 0.0

    def __enter__(self) -> "CompileTimer":
        self._before = (_LISTENER.wall, _LISTENER.cpu)
        return self

    @property
    def so_far(self) -> float:
        """Wall time of compilation since the block began (s)."""
        return _LISTENER.wall - self._before[0]

    def __exit__(self, *exception) -> None:
        self.wall = _LISTENER.wall - self._before[0]
        self.cpu = _LISTENER.cpu - self._before[1]
