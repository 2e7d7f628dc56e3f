"""The cubic spline: normalisation, slope, and the pieces that the thesis prints."""

import numpy as np
import pytest
from scipy.integrate import quad

from sphstudy.sph import kernel


def printed(q):
    """W/α_k exactly as (2.7) prints it."""
    if q <= 1.0:
        return 2.0 / 3.0 - q**2 + 0.5 * q**3
    return (2.0 - q) ** 3 / 6.0 if q <= 2.0 else 0.0


def test_integrates_to_one_in_the_plane():
    for length in (0.3, 1.0, 7.0):
        integral, _ = quad(
            lambda r, h=length: 2.0 * np.pi * r * kernel.normalisation(h) * kernel.value(r / h),
            0.0,
            2.0 * length,
            points=[length],
        )
        assert integral == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("q", [0.0, 0.2, 2.0 / 3.0, 1.0, 1.4, 1.999, 2.0, 2.5])
def test_is_the_printed_polynomial(q):
    assert kernel.value(q) == pytest.approx(printed(q), abs=1e-15)


@pytest.mark.parametrize("q", [0.1, 0.5, 0.9, 1.1, 1.5, 1.9])
def test_slope_is_the_derivative(q):
    step = 1e-6
    difference = (kernel.value(q + step) - kernel.value(q - step)) / (2.0 * step)
    assert kernel.slope(q) == pytest.approx(difference, abs=1e-9)


def test_vanishes_outside_the_support():
    assert kernel.value(2.0) == kernel.slope(2.0) == kernel.value(3.0) == kernel.slope(3.0) == 0.0


def test_curvature_changes_sign_at_two_thirds():
    """Why h̃ = 1.5 is special: the nearest neighbour, at 1/h̃, sits on the inflection."""
    step = 1e-5
    curvature = [
        (kernel.slope(q + step) - kernel.slope(q - step)) / (2.0 * step) for q in (0.6, 2.0 / 3.0, 0.7)
    ]
    assert curvature[0] < 0.0 < curvature[2]
    assert curvature[1] == pytest.approx(0.0, abs=1e-6)
