"""How wide an accepted interval is: the effects of a made-up choices study."""

import pytest

from sphstudy.analysis import reference
from sphstudy.analysis.effects import CONTROL, Effect
from sphstudy.analysis.intervals import ABOVE_ROUNDING, SHARE, tolerances


def effect(varied, change, block="plate", metric="frequency"):
    return Effect(block, varied, metric, 1.0, 1.0 + change, "rad s-1")


def test_half_of_the_smallest_effect_of_any_block():
    found = [
        effect(f"{CONTROL}=0.3", 1e-12),
        effect("scene.plane=stress", -0.3),
        effect("scene.columns=spacing", 0.004),
        effect("scene.columns=spacing", -0.002, block="bending"),
    ]
    tolerance = tolerances(found)["frequency"]
    assert tolerance.half_width == pytest.approx(SHARE * 0.002)
    assert "0.002 by scene.columns=spacing in bending" in tolerance.reason
    assert 2.0 * tolerance.half_width <= 3.0 * 0.002


def test_what_is_no_larger_than_rounding_is_no_effect():
    noise = 1e-5
    found = [
        effect(f"{CONTROL}=0.3", noise),
        effect("scene.plane=stress", 0.9 * ABOVE_ROUNDING * noise),
        effect("scene.columns=spacing", 0.1),
    ]
    assert tolerances(found)["frequency"].half_width == pytest.approx(0.05)
    # The control of one block says nothing about another.
    elsewhere = [*found, effect("scene.plane=stress", 1e-6, block="bending")]
    assert tolerances(elsewhere)["frequency"].half_width == pytest.approx(5e-7)


def test_a_metric_that_no_choice_touches_may_only_be_rounded():
    found = [effect(f"{CONTROL}=0.3", 1e-13), effect("scene.plane=stress", 0.0)]
    tolerance = tolerances(found)["frequency"]
    assert tolerance.half_width == pytest.approx(1e-9)
    assert "rounding only" in tolerance.reason


def test_each_metric_has_its_own():
    found = [effect("a=1", 0.1), effect("a=1", 0.2, metric="amplitude")]
    assert {m: t.half_width for m, t in tolerances(found).items()} == pytest.approx(
        {"frequency": 0.05, "amplitude": 0.1}
    )


def test_of_two_methods_choices_the_wider_interval_holds():
    """Blocks of the same name in both, but each method's choices and rounding count for itself."""
    one = tolerances([effect("a=1", 4.0), effect("a=1", 3.0, metric="decay")])
    other = tolerances([effect("b=1", 0.5), effect("b=1", 8.0, metric="decay")])
    held = reference._widest([one, other])
    assert held["frequency"].half_width == SHARE * 4.0
    assert held["decay"].half_width == SHARE * 8.0
    assert "b=1" in held["decay"].reason
