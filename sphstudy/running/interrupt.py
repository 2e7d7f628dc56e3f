"""Ctrl-C that ends the program, even where a library swallows it or turns it into another error."""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType
from typing import Any

AGAIN = 0.5
"""Seconds between two signals to a library that drops interrupts."""


class _Handler:
    """A SIGINT handler: calls `handle`, then the previous handler `then`. A class of its own, so that
    handlers of this program are recognised.
    """

    def __init__(self, handle: Callable[[], None], then: Callable[[int, FrameType | None], Any]):
        self._handle, self._then = handle, then

    def __call__(self, number: int, frame: FrameType | None) -> None:
        self._handle()
        self._then(number, frame)


@contextlib.contextmanager
def on_interrupt(handle: Callable[[], None]) -> Iterator[None]:
    """Calls `handle` at Ctrl-C while the block works, before a KeyboardInterrupt is raised.

    Where the process ignores SIGINT or has a handler that is not Python's, and in other threads than the
    main one, which never get signals, the block works as it would without.

    Parameters
    ----------
    handle : callable
        Called by the signal handler.
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
    """Turns whatever leaves the block after Ctrl-C into a KeyboardInterrupt.

    Hydra turns a KeyboardInterrupt into another error while it reads files.

    Parameters
    ----------
    insisting : bool
        Whether the signal is repeated until the block is left: llvmlite drops exceptions while it
        compiles.

    Raises
    ------
    KeyboardInterrupt
        If Ctrl-C came and an exception leaves the block.
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
