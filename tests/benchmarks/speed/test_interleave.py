"""Turns and slices, with a clock that is told how time goes by."""

import numpy as np
import pytest

from sphstudy.benchmarks.speed.interleave import Stepper, interleaved


class Clock:
    """Stands still but for what is added to it."""

    now = 0.0

    def __call__(self):
        return self.now


class Walker:
    """A system whose steps take time by the clock, and that goes bad at a step."""

    def __init__(self, clock, step_seconds, bad=10**9):
        self.clock, self.step_seconds, self.bad, self.calls = clock, step_seconds, bad, []

    def advance(self, begin, end):
        self.calls.append((begin, end))
        self.clock.now += (end - begin) * self.step_seconds
        return end, "a value that is not finite" if end >= self.bad else ""


def test_variants_take_turns_and_a_drift_meets_all_alike():
    clock, order = Clock(), []

    def action(name, cost):
        def act():
            order.append(name)
            # From the third round on the machine is half as fast.
            clock.now += cost * (1.0 if len(order) <= 6 else 2.0)

        return act

    seconds = interleaved([action("a", 1.0), action("b", 2.0), action("c", 4.0)], 4, clock)
    assert "".join(order) == "abcbcacababc"
    np.testing.assert_allclose(seconds[:, 0], [1.0, 2.0, 4.0])
    np.testing.assert_allclose(seconds[1] / seconds[0], 2.0)
    np.testing.assert_allclose(seconds[2] / seconds[0], 4.0)
    np.testing.assert_allclose(seconds[0], [1.0, 1.0, 2.0, 2.0])


@pytest.mark.parametrize(("step_seconds", "steps"), [(0.001, 200), (0.03, 7), (5.0, 1)])
def test_a_slice_has_as_many_steps_as_fill_it_and_one_at_least(step_seconds, steps):
    clock = Clock()
    walker = Walker(clock, step_seconds)
    stepper = Stepper(walker, 0.2, clock)
    assert stepper.steps == steps
    stepper()
    begin, end = walker.calls[-1]
    assert end - begin == steps
    # Each call goes on where the one before ended.
    assert [b for b, _ in walker.calls] == [0, *(e for _, e in walker.calls[:-1])]


def test_a_system_that_goes_bad_is_not_stepped_again():
    clock = Clock()
    walker = Walker(clock, 0.001, bad=300)
    stepper = Stepper(walker, 0.2, clock)
    assert not stepper.wrong
    for _ in range(3):
        stepper()
    assert stepper.wrong == "a value that is not finite"
    assert sum(end >= 300 for _, end in walker.calls) == 1
