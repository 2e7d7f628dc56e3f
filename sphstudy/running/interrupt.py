"""Ctrl-C that is obeyed, whatever libraries make of it."""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType
from typing import Any

AGAIN = 0.5
"""Seconds after which a library that has dropped an interrupt meets the next."""


class _Handler:
    """What is to be done about Ctrl-C, and then. Known as this program's."""

    def __init__(self, handle: Callable[[], None], then: Callable[[int, FrameType | None], Any]):
        self._handle, self._then = handle, then

    def __call__(self, number: int, frame: FrameType | None) -> None:
        self._handle()
        self._then(number, frame)


@contextlib.contextmanager
def on_interrupt(handle: Callable[[], None]) -> Iterator[None]:
    """Ctrl-C calls `handle` while the block works, before it becomes a KeyboardInterrupt. A process that
    was told to ignore it, or to do something else about it, obeys; and of the threads of a process only
    the main one hears of it.
    """
    before: Any = signal.getsignal(signal.SIGINT)
    ours = before is signal.default_int_handler or isinstance(before, _Handler)
    if not ours or threading.current_thread() is not threading.main_thread():
        yield
        return
    signal.signal(signal.SIGINT, _Handler(handle, before))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def interruptible(insisting: bool = False) -> Iterator[None]:
    """Ctrl-C leaves the block as a KeyboardInterrupt, whatever a library has made of it on the way: Hydra
    makes another error of it while it reads files.

    insisting: it comes again until the block is left. llvmlite, while it compiles, drops what is raised.
    """
    # A list, not an event: another interrupt may come while this one is noted, and wait for the lock.
    came: list[bool] = []
    left, main = threading.Event(), threading.main_thread()

    def note() -> None:
        came.append(True)
        if insisting and len(came) == 1:
            threading.Thread(target=insist, daemon=True).start()

    def insist() -> None:
        while not left.wait(AGAIN):
            signal.pthread_kill(main.ident or 0, signal.SIGINT)

    with on_interrupt(note):
        try:
            yield
        except Exception:
            if came:
                raise KeyboardInterrupt from None
            raise
        finally:
            left.set()
