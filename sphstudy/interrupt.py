"""Ctrl-C that is obeyed, whatever libraries make of it."""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType

AGAIN = 0.5
"""Seconds after which a library that has dropped an interrupt meets the next."""


class _Handler:
    """What is to be done about Ctrl-C, known as this program's."""

    def __init__(self, handle: Callable[[], None]):
        self._handle = handle

    def __call__(self, number: int, frame: FrameType | None) -> None:
        self._handle()


@contextlib.contextmanager
def on_interrupt(handle: Callable[[], None]) -> Iterator[None]:
    """Ctrl-C calls `handle` while the block works. A process that was told to ignore it, or to do
    something else about it, obeys; and of the threads of a process only the main one hears of it.
    """
    before = signal.getsignal(signal.SIGINT)
    usual = before is signal.default_int_handler or isinstance(before, _Handler)
    if not usual or threading.current_thread() is not threading.main_thread():
        yield
        return
    signal.signal(signal.SIGINT, _Handler(handle))
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
    came, left, main = threading.Event(), threading.Event(), threading.main_thread()

    def interrupt() -> None:
        if insisting and not came.is_set():
            threading.Thread(target=insist, daemon=True).start()
        came.set()
        raise KeyboardInterrupt

    def insist() -> None:
        while not left.wait(AGAIN):
            signal.pthread_kill(main.ident or 0, signal.SIGINT)

    with on_interrupt(interrupt):
        try:
            yield
        except Exception:
            if came.is_set():
                raise KeyboardInterrupt from None
            raise
        finally:
            left.set()
