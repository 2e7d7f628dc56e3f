"""The kernels: normalisation, derivatives, and the pieces that the thesis prints."""

import numpy as np
import pytest
from scipy.integrate import quad

from sphstudy.numerics.sph import kernel
from sphstudy.numerics.sph.kernel import KERNELS

every_kernel = pytest.mark.parametrize("shape", KERNELS.values(), ids=KERNELS.keys())


def printed(q):
    """W/α_k exactly as (2.7) prints it."""
    if q <= 1.0:
        return 2.0 / 3.0 - q**2 + 0.5 * q**3
    return (2.0 - q) ** 3 / 6.0 if q <= 2.0 else 0.0


@every_kernel
def test_integrates_to_one_in_the_plane(shape):
    for length in (0.3, 7.0):
        integral, _ = quad(
            lambda r, h=length: 2.0 * np.pi * r * shape.normalisation(h) * kernel.value(shape, r / h),
            0.0,
            shape.support * length,
            points=[length, 2.0 * length],
        )
        assert integral == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("q", [0.0, 0.2, 2.0 / 3.0, 1.0, 1.4, 1.999, 2.0, 2.5])
def test_cubic_spline_is_the_printed_polynomial(q):
    assert kernel.value(KERNELS["cubic"], q) == pytest.approx(printed(q), abs=1e-15)


@every_kernel
@pytest.mark.parametrize("q", [0.1, 0.5, 0.9, 1.1, 1.5, 1.9, 2.4])
def test_slope_and_curvature_are_the_derivatives(shape, q):
    step = 1e-5
    for function, derivative in ((kernel.value, kernel.slope), (kernel.slope, kernel.curvature)):
        difference = (function(shape, q + step) - function(shape, q - step)) / (2.0 * step)
        size = abs(derivative(shape, 0.25))
        assert derivative(shape, q) == pytest.approx(difference, abs=1e-8 * size)


@every_kernel
def test_vanishes_outside_the_support(shape):
    for q in (shape.support, shape.support + 0.5):
        assert kernel.value(shape, q) == kernel.slope(shape, q) == kernel.curvature(shape, q) == 0.0


def test_curvature_of_the_cubic_spline_changes_sign_at_two_thirds():
    """Why h̃ = 1.5 is special: the nearest neighbour, at 1/h̃, sits on the inflection."""
    curvature = [kernel.curvature(KERNELS["cubic"], q) for q in (0.6, 2.0 / 3.0, 0.7)]
    assert curvature[0] < 0.0 < curvature[2]
    assert curvature[1] == pytest.approx(0.0, abs=1e-15)
