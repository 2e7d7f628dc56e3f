"""One worker beside two: the order of turns, and what is said where a run cannot be shared."""

import time

import numba
import numpy as np
import pytest

from sphstudy.benchmarks.speed import parallel
from sphstudy.benchmarks.speed.parallel import Control, Scaling, compared, threads


def test_the_control_has_its_turn_between_one_worker_and_two(monkeypatch):
    order = []
    control = Control(0.001)
    monkeypatch.setattr(control, "one", lambda: order.append("control one"))
    monkeypatch.setattr(control, "two", lambda: order.append("control two"))
    found = compared(
        "work",
        "threads",
        lambda: order.append("one"),
        lambda: order.append("two"),
        control,
        2,
        "two threads",
    )
    assert order[:4] == ["one", "control one", "two", "control two"]
    assert sorted(order[4:]) == sorted(order[:4])
    assert found.seconds.shape == found.control.shape == (2, 2)


def test_the_control_does_both_portions_either_way(monkeypatch):
    done = []
    control = Control(0.001)
    monkeypatch.setattr(control, "_portion", lambda _=0: done.append(1))
    control.one()
    control.two()
    assert len(done) == 4


def test_a_speed_up_is_of_times_in_the_same_round():
    # The machine was three times slower in the last round.
    scaling = Scaling(
        "work", "threads", np.array([[2.0, 2.0, 6.0], [1.0, 1.25, 3.0]]), np.ones((2, 3)), "two threads"
    )
    assert scaling.speedup == pytest.approx(2.0)
    assert scaling.control_speedup == 1.0


class Standing:
    """A system that does not move, but takes its time."""

    def __init__(self):
        self.system = self

    def advance(self, begin, end):
        time.sleep(1e-4 * (end - begin))
        return end, ""


def test_one_core_is_said_and_on_two_each_method_runs_on_one_thread_and_on_two(monkeypatch):
    asked = []
    monkeypatch.setattr(
        parallel, "made", lambda hydra, case, threads: asked.append((case.label, threads)) or Standing()
    )
    monkeypatch.setattr(numba, "set_num_threads", lambda count: None)
    monkeypatch.setattr(numba.config, "NUMBA_NUM_THREADS", 2)
    found, remark = threads(None, 5, 1, 0.001)
    assert not remark
    assert [scaling.label for scaling in found] == ["thesis, plate n=5", "tl, plate n=5"]
    assert asked == [("thesis on 1", 1), ("thesis on 2", 2), ("tl on 1", 1), ("tl on 2", 2)]
    monkeypatch.setattr(numba.config, "NUMBA_NUM_THREADS", 1)
    found, remark = threads(None, 5, 1, 0.001)
    assert not found
    assert "there is one core" in remark
