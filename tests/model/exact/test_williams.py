"""Williams' fields against Hooke's law, equilibrium and the crack's free faces, by differentiation."""

import numpy as np
import pytest

from sphstudy.model.exact import williams
from sphstudy.model.material import Material

E, NU, K = 6e6, 0.3, 35.8e3
POINTS = np.array([(0.03, 0.01), (-0.02, 0.04), (-0.05, -0.01), (0.01, -0.06), (0.08, 0.0)])


def gradient(field, x, y, step=1e-6):
    """∂/∂x and ∂/∂y of each component of a field, by central differences."""
    along_x = (np.array(field(x + step, y)) - np.array(field(x - step, y))) / (2 * step)
    along_y = (np.array(field(x, y + step)) - np.array(field(x, y - step))) / (2 * step)
    return along_x, along_y


@pytest.mark.parametrize("mode", [1, 2])
def test_stress_follows_from_displacement_by_hookes_law(mode):
    x, y = POINTS.T
    along_x, along_y = gradient(lambda x, y: williams.displacement(mode, x, y, K, E, NU), x, y)
    exx, eyy, exy = along_x[0], along_y[1], 0.5 * (along_x[1] + along_y[0])
    material = Material(E, NU, 1.0, "stress")
    trace = material.lame_modulus * (exx + eyy)
    expected = (
        trace + 2 * material.shear_modulus * exx,
        trace + 2 * material.shear_modulus * eyy,
        2 * material.shear_modulus * exy,
    )
    scale = K / np.sqrt(2 * np.pi * 0.03)
    for one, other in zip(williams.stress(mode, x, y, K), expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-6 * scale)


@pytest.mark.parametrize("mode", [1, 2])
def test_stress_is_in_equilibrium(mode):
    x, y = POINTS.T
    along_x, along_y = gradient(lambda x, y: williams.stress(mode, x, y, K), x, y)
    scale = np.abs(along_x).max()
    np.testing.assert_allclose(along_x[0] + along_y[2], 0.0, atol=1e-6 * scale)
    np.testing.assert_allclose(along_x[2] + along_y[1], 0.0, atol=1e-6 * scale)


@pytest.mark.parametrize("mode", [1, 2])
@pytest.mark.parametrize("side", [1e-15, -1e-15])
def test_crack_faces_are_free(mode, side):
    x = -np.array([0.01, 0.05])
    _, syy, sxy = williams.stress(mode, x, np.full(2, side), K)
    assert np.abs([syy, sxy]).max() < 1e-9 * K


def test_ahead_of_the_tip_the_stress_is_k_over_root_two_pi_r():
    r = np.array([0.01, 0.04])
    assert williams.stress(1, r, 0 * r, K)[1] == pytest.approx(K / np.sqrt(2 * np.pi * r))
    assert williams.stress(2, r, 0 * r, K)[2] == pytest.approx(K / np.sqrt(2 * np.pi * r))


def test_opening_of_the_faces_is_that_of_the_energy_release_rate():
    """Irwin: closing the crack over d takes K²/E per area."""
    d = 1e-3
    s, weights = np.polynomial.legendre.leggauss(400)
    r = 0.5 * d * (s + 1)
    opening = 2 * williams.displacement(1, -(d - r), 1e-18 * r, K, E, NU)[1]
    work = np.sum(weights * 0.5 * d * 0.5 * opening * williams.stress(1, r, 0 * r, K)[1]) / d
    assert work == pytest.approx(williams.energy_release_rate(K, E), rel=2e-3)


@pytest.mark.parametrize("mode", [1, 2])
def test_displacement_gradient_is_that_of_the_displacement(mode):
    x, y = POINTS.T
    along_x, along_y = gradient(lambda x, y: williams.displacement(mode, x, y, K, E, NU), x, y)
    exact = williams.displacement_gradient(mode, x, y, K, E, NU)
    scale = K / (E * np.sqrt(2 * np.pi * 0.03))
    differences = (along_x[0], along_y[0], along_x[1], along_y[1])
    np.testing.assert_allclose(exact, differences, rtol=0, atol=1e-8 * scale)


def test_there_are_two_modes():
    with pytest.raises(ValueError, match="must be 1 or 2"):
        williams.displacement(3, 1.0, 0.0, K, E, NU)
    with pytest.raises(ValueError, match="must be 1 or 2"):
        williams.displacement_gradient(0, 1.0, 0.0, K, E, NU)
