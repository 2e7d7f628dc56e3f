"""Ctrl-C that libraries drop or make another error of."""

import contextlib
import signal
import threading
import time

import pytest

from sphstudy.running.interrupt import AGAIN, interruptible, on_interrupt


@pytest.fixture(autouse=True)
def usual():
    """Ctrl-C as a terminal has it, whatever the tests were started by."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    signal.signal(signal.SIGINT, before)


def dropped():
    """What llvmlite does with Ctrl-C."""
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def test_another_error_that_was_made_of_it_is_an_interrupt():
    def read():
        dropped()
        raise ValueError("no file")

    with pytest.raises(KeyboardInterrupt), interruptible():
        read()


def test_an_error_without_it_stays_one():
    with pytest.raises(ValueError, match="no file"), interruptible(insisting=True):
        raise ValueError("no file")


def test_one_that_was_dropped_comes_again_and_again():
    def compile_all():
        dropped()
        with pytest.raises(KeyboardInterrupt):
            time.sleep(10)
        time.sleep(10)

    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt), interruptible(insisting=True):
        compile_all()
    assert time.monotonic() - begun < 5


def wait():
    """As long as it takes several interrupts to come."""
    end = time.monotonic() + 3 * AGAIN
    while time.monotonic() < end:
        with contextlib.suppress(KeyboardInterrupt):
            time.sleep(0.1)


def test_none_comes_after_the_block_is_left():
    came = []
    with on_interrupt(lambda: came.append(1)):
        with pytest.raises(KeyboardInterrupt), interruptible(insisting=True):
            signal.raise_signal(signal.SIGINT)
        wait()
    assert came == [1]


@pytest.mark.parametrize("insisting", [False, True])
def test_unless_asked_for_it_comes_once(insisting):
    """Whoever ends jobs elsewhere because of it needs time for that."""
    came = []
    with on_interrupt(lambda: came.append(1)), interruptible(insisting):
        dropped()
        wait()
    assert (len(came) > 1) == insisting


def test_of_two_blocks_both_hear_of_it_the_inner_first():
    came = []
    with on_interrupt(lambda: came.append("outer")):
        with on_interrupt(lambda: came.append("inner")):
            dropped()
        dropped()
    assert came == ["inner", "outer", "outer"]


@pytest.mark.parametrize("told", [signal.SIG_IGN, lambda number, frame: None])
def test_whoever_told_the_process_what_to_do_about_it_is_obeyed(told):
    signal.signal(signal.SIGINT, told)
    with interruptible(insisting=True):
        signal.raise_signal(signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) is told
    signal.signal(signal.SIGINT, signal.default_int_handler)


def test_in_another_thread_nothing_is_changed():
    seen = []

    def work():
        with interruptible():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [signal.default_int_handler]
