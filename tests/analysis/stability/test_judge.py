"""Judged is what the record holds: outcome, first breach in time, and how far it went."""

import numpy as np
import pytest

from sphstudy.analysis.stability import indicators
from sphstudy.analysis.stability.bounds import Bound
from sphstudy.analysis.stability.judge import judge
from sphstudy.configuration.composition import session
from tests.support.records import MASS, SAMPLES, two_particles

STILL, TIME = np.zeros(SAMPLES), np.arange(float(SAMPLES))


@pytest.fixture(scope="module")
def config():
    with session() as hydra:
        return hydra.points(["scene=plate", "n=5"], sweep=False)[0][0].config


def bound(quantity, at_most=None, at_least=None):
    limits = {"at_most": at_most, "at_least": at_least}
    return Bound(quantity=quantity, **limits, where={}, reason="r", source="s", general=False)


SPACING, SPEED = bound("history.smallest_spacing", at_least=0.5), bound("history.speed", at_most=1.0)
REBOUND = bound("rebound", at_most=1.0)


def test_a_run_inside_its_bounds_is_done(config):
    found = judge(two_particles(config, metrics={"rebound": 1.0}), [SPACING, SPEED, REBOUND])
    assert (found.outcome, found.breaches, found.unjudged) == ("done", (), ())
    assert np.isnan(found.time)


def test_a_history_outside_is_degraded_since_its_first_sample(config):
    spacing = np.where(TIME < 3.0, 1.0, 0.4)
    spacing[6] = 0.2
    fast = np.where(TIME == 2.0, 1e9, 0.0)
    run = two_particles(config, metrics={"rebound": 2.0}, smallest_spacing=spacing, largest_speed=fast)
    found = judge(run, [REBOUND, SPACING, SPEED])
    assert (found.outcome, found.time) == ("degraded", 2.0)
    assert [(b.bound.quantity, b.time) for b in found.breaches] == [
        ("history.speed", 2.0), ("history.smallest_spacing", 3.0), ("rebound", 10.0)
    ]  # fmt: skip
    assert [b.value for b in found.breaches[1:]] == [0.2, 2.0]


def test_samples_without_a_number_do_not_count(config):
    defect = np.full(SAMPLES, np.nan)
    mirror = bound("history.mirror_defect", at_most=0.1)
    found = judge(two_particles(config, mirror_defect=defect), [mirror])
    assert (found.outcome, found.unjudged) == ("done", (mirror,))
    defect[4:6] = 0.05, 0.3
    found = judge(two_particles(config, mirror_defect=defect), [mirror])
    assert (found.outcome, found.time, found.breaches[0].value) == ("degraded", 5.0, 0.3)


def test_a_metric_without_a_number_is_outside_and_one_that_is_not_there_unjudged(config):
    found = judge(two_particles(config, metrics={"rebound": np.nan}), [REBOUND])
    assert (found.outcome, found.time) == ("degraded", 10.0)
    assert np.isnan(found.breaches[0].value)
    # A variable that is no metric is not one either.
    for missing in (REBOUND, bound("time_step", at_most=0.0)):
        assert judge(two_particles(config), [missing]).unjudged == (missing,)


def test_a_diverged_run_says_by_what_it_had_gone_bad(config):
    run = two_particles(config, "diverged", message="a step too far", largest_speed=1e4 * TIME)
    found = judge(run, [SPACING, REBOUND, SPEED])
    assert (found.outcome, found.time, found.message) == ("diverged", 1.0, "a step too far")
    assert [b.bound for b in found.breaches] == [SPEED]
    sudden = judge(two_particles(config, "diverged", message="a step too far"), [SPACING, SPEED])
    assert (sudden.outcome, sudden.breaches, sudden.time) == ("diverged", (), 10.0)


def test_what_has_no_result_is_not_judged(config):
    assert judge(None, [SPEED]).outcome == "missing"
    failed = judge(
        two_particles(config, "failed", message="ValueError", largest_speed=1e9 * TIME), [SPEED]
    )
    assert (failed.outcome, failed.breaches, failed.message) == ("failed", (), "ValueError")
    assert (
        judge(
            two_particles(config, "diverged", times=np.empty(0), states=[(0.0, np.eye(2))]), [SPEED]
        ).time
        is not None
    )


def test_energy_is_compared_with_the_most_put_in(config):
    # 1 J at first; 2 W for 10 s put in 20 J more, of which 3 J too many are found at last.
    found = 1.0 + 2.0 * TIME + 3.0 * (TIME == 10.0) - 6.3 * (TIME == 8.0)
    run = two_particles(config, kinetic_energy=found, strain_energy=STILL, constraint_power=STILL + 2.0)
    gain = indicators.measure(run, "energy_gain")
    np.testing.assert_allclose(gain, 3.0 / 21.0 * (TIME == 10.0) - 0.3 * (TIME == 8.0), atol=1e-15)
    np.testing.assert_allclose(indicators.measure(run, "energy_error"), np.abs(gain))


def test_drifts_compare_with_what_the_body_could_carry(config):
    # Both particles at 2 m/s, or the body turning about the origin at 5 rad/s: all of it lost is 1.
    momentum = MASS.sum() * 2.0 * (TIME < 4.0)
    run = two_particles(config, momentum_y=momentum, kinetic_energy=STILL + 0.5 * MASS.sum() * 4.0)
    np.testing.assert_allclose(indicators.measure(run, "momentum_drift"), TIME >= 4.0)
    turning = MASS[1] * 5.0 * (TIME < 7.0)
    run = two_particles(config, angular_momentum=turning, kinetic_energy=STILL + 0.5 * MASS[1] * 25.0)
    np.testing.assert_allclose(indicators.measure(run, "angular_momentum_drift"), TIME >= 7.0)
    np.testing.assert_array_equal(indicators.measure(two_particles(config), "momentum_drift"), STILL)


def test_speed_and_spacing_are_those_of_the_scene(config):
    run = two_particles(config, largest_speed=TIME, smallest_spacing=TIME)
    # K = E / (3 (1 - 2 nu)).
    np.testing.assert_allclose(indicators.measure(run, "speed"), TIME / np.sqrt(1e6 / 1.2 / 7750.0))
    np.testing.assert_allclose(indicators.measure(run, "smallest_spacing"), TIME / 1.0)
