"""One worker beside two: the order of turns, and what is said where a run cannot be shared."""

import numpy as np
import pytest

from sphstudy.composition import session
from sphstudy.speed import parallel
from sphstudy.speed.parallel import Control, Scaling, compared, threads


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


def test_a_version_without_threads_says_so_and_one_with_them_is_timed(monkeypatch):
    with session() as hydra:
        monkeypatch.setattr(parallel, "THREADS", "solve.no_such_setting")
        found, remark = threads(hydra, 5, 1, 0.001)
        assert not found
        assert "this version has no setting solve.no_such_setting" in remark
        # A setting that takes 1 and 2 stands for the number of threads.
        monkeypatch.setattr(parallel, "THREADS", "seed")
        found, remark = threads(hydra, 5, 1, 0.001)
    assert not remark
    assert [scaling.label for scaling in found] == ["thesis, plate n=5", "tl, plate n=5"]
    assert all((scaling.seconds > 0.0).all() for scaling in found)
