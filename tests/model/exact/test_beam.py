"""The beam's answers against the beam's own equations."""

import math

import pytest
from scipy.optimize import brentq

from sphstudy.model.exact import beam


def derivative(function, x, order, step=2e-3):
    """Central differences of the given order."""
    if order == 0:
        return function(x)
    inner = lambda at: derivative(function, at, order - 1, step)  # noqa: E731
    return (inner(x + step / 2) - inner(x - step / 2)) / step


def test_mode_shape_is_clamped_and_free():
    shape = lambda x: beam.mode_shape(x, 1.0)  # noqa: E731
    assert shape(0.0) == pytest.approx(0.0, abs=1e-15)
    assert derivative(shape, 0.0, 1) == pytest.approx(0.0, abs=1e-4)
    assert shape(1.0) == 1.0
    assert derivative(shape, 1.0, 2) == pytest.approx(0.0, abs=1e-3)
    assert derivative(shape, 1.0, 3) == pytest.approx(0.0, abs=1e-2)


def test_mode_shape_solves_the_beam_equation():
    shape = lambda x: beam.mode_shape(x, 2.0)  # noqa: E731
    for x in (0.5, 1.0, 1.5):
        fourth = derivative(shape, x, 4, step=0.02)
        assert fourth == pytest.approx((beam.ROOT / 2.0) ** 4 * shape(x), rel=1e-3)


def test_frequency_of_the_thesis_plate():
    """0.960789 rad/s with the root to all digits, 1.875104; the thesis prints 1.8751."""
    omega = beam.fundamental_frequency(1e6, 7750.0, 1.0, 1.0 / 12.0)
    assert omega * (1.8751040687 / 1.8751) ** 2 == pytest.approx(0.960789, abs=5e-7)


def test_thin_plate_is_stiffer_than_a_beam():
    """Gray, Monaghan and Swift's plate has a period of 0.254 s."""
    omega = beam.thin_plate_frequency(2e6, 0.3975, 1000.0, 0.2, 0.02)
    assert 2.0 * math.pi / omega == pytest.approx(0.254, abs=5e-5)


def test_root_solves_the_frequency_equation_to_its_printed_digits():
    exact = brentq(lambda a: math.cos(a) * math.cosh(a) + 1.0, 1.5, 2.5)
    assert exact == pytest.approx(beam.ROOT, abs=5e-5)


def test_bent_centreline_is_clamped_moved_and_without_moment_at_the_driven_end():
    line = lambda x: beam.bent_centreline(x, -0.04, 1.0, 0.02)  # noqa: E731
    assert line(0.0) == pytest.approx(0.0, abs=1e-15)
    assert derivative(line, 0.0, 1) == pytest.approx(0.0, abs=1e-6)
    assert line(0.99) == pytest.approx(-0.04, rel=1e-14)
    assert derivative(line, 0.99, 2) == pytest.approx(0.0, abs=1e-5)


def test_end_angle_is_the_slope_of_the_centreline():
    slope = derivative(lambda x: beam.bent_centreline(x, -0.04, 1.0, 0.02), 0.99, 1)
    assert beam.end_angle(-0.04, 1.0, 0.02) == pytest.approx(slope, rel=1e-5)
