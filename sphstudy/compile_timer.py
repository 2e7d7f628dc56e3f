"""Time spent compiling, told apart from time spent running."""

import time

from numba.core import event


class _Listener(event.Listener):
    """Adds up the outermost compilation events of this process."""

    def __init__(self) -> None:
        self.total = 0.0
        self._depth = 0
        self._began = 0.0

    def on_start(self, event) -> None:
        if self._depth == 0:
            self._began = time.perf_counter()
        self._depth += 1

    def on_end(self, event) -> None:
        self._depth -= 1
        if self._depth == 0:
            self.total += time.perf_counter() - self._began


_LISTENER = _Listener()
event.register("numba:compile", _LISTENER)


class CompileTimer:
    """Seconds spent compiling inside a `with` block (nearly 0 from a warm cache)."""

    seconds = 0.0

    def __enter__(self) -> "CompileTimer":
        self._before = _LISTENER.total
        return self

    def __exit__(self, *exception) -> None:
        self.seconds = _LISTENER.total - self._before
