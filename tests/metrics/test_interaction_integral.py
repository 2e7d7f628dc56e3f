"""Domain integrals on exact fields, sampled where the crack scene has its particles."""

import itertools

import numpy as np
import pytest

from sphstudy.metrics.interaction_integral import (
    Annulus,
    fits,
    j_integral,
    stress_intensities,
    weight_gradient,
)
from sphstudy.model.exact import williams
from sphstudy.model.lattice import lattice

E, NU, K, SIDE = 6e6, 0.3, 35.8e3, 0.2
T = K / np.sqrt(np.pi * 0.5 * SIDE)
WHOLE = Annulus(0.02, 0.08)
PARTS = (Annulus(0.02, 0.05), Annulus(0.035, 0.065), Annulus(0.05, 0.08))
MODES = [(1.0, 0.0), (0.0, 1.0), (0.8, -0.6), (-0.3, 0.95)]


class Sample:
    """Williams' field of k1, k2 (in units of K) with a T-stress (in units of T), tip at the origin."""

    def __init__(self, n, k1, k2, t=0.0):
        spacing = SIDE / n
        line = spacing * (np.arange(n) - 0.5 * (n - 1))
        self.x, self.y = lattice(line, line)
        self.volume = np.full(self.x.size, spacing**2)
        one = np.ones(self.x.size)
        self.P, self.H = np.zeros((2, 4, self.x.size))
        for mode, value in ((1, k1 * K), (2, k2 * K)):
            xx, yy, xy = williams.stress(mode, self.x, self.y, value)
            self.P += [xx, xy, xy, yy]
            self.H += williams.displacement_gradient(mode, self.x, self.y, value, E, NU)
        self.P += np.multiply.outer([t * T, 0.0, 0.0, 0.0], one)
        self.H += np.multiply.outer([t * T / E, 0.0, 0.0, -NU * t * T / E], one)

    def intensities(self, annulus=WHOLE, tip_x=0.0):
        """K_I, K_II in units of K."""
        field = (self.x + tip_x, self.y, self.volume, self.P, self.H)
        return np.array(stress_intensities(*field, annulus, tip_x, E, NU)) / K

    def j(self, annulus=WHOLE, tip_x=0.0):
        """J in units of K²/E."""
        psi = 0.5 * np.sum(self.P * self.H, axis=0)
        field = (self.x + tip_x, self.y, self.volume, self.P, self.H, psi)
        return j_integral(*field, annulus, tip_x) / (K**2 / E)


@pytest.mark.parametrize("n", [40, 60])
@pytest.mark.parametrize("t", [0.0, 1.0])
@pytest.mark.parametrize(("k1", "k2"), MODES)
def test_intensities_and_j_are_those_of_the_field_whatever_the_t_stress(n, k1, k2, t):
    sample = Sample(n, k1, k2, t)
    assert sample.intensities() == pytest.approx(
        (k1, k2), rel=0.0 if t else 1e-4, abs=1e-4 if t else 1e-12
    )
    assert sample.j() == pytest.approx(k1**2 + k2**2, rel=2e-4)


@pytest.mark.parametrize("n", [40, 60])
@pytest.mark.parametrize("t", [0.0, 1.0])
def test_modes_do_not_mix(n, t):
    assert abs(Sample(n, 1.0, 0.0, t).intensities()[1]) < 1e-12
    assert abs(Sample(n, 0.0, 1.0).intensities()[0]) < 1e-12


def test_t_stress_alone_has_no_j_and_leaves_the_order_of_the_faces_in_k():
    """J of a uniform field vanishes; the midpoint rule at the crack faces is of second order."""
    coarse, fine = (Sample(n, 0.0, 0.0, 1.0) for n in (40, 80))
    assert abs(fine.j()) < 1e-10
    error, finer = coarse.intensities()[0], fine.intensities()[0]
    assert abs(error) < 1e-4
    assert error / finer == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize(
    ("n", "t", "spread", "error"),
    [
        (40, 0.0, 6.5e-5, 1.2e-4),
        (40, 1.0, 1e-4, 1.7e-4),
        (60, 0.0, 2e-5, 1.1e-5),
        (60, 1.0, 4e-5, 6.5e-5),
    ],
)
@pytest.mark.parametrize(("k1", "k2"), MODES)
def test_intensities_do_not_depend_on_the_contour(n, t, spread, error, k1, k2):
    """What the quadrature leaves over six (n = 40) or nine (n = 60) spacings, and of a T-stress."""
    sample = Sample(n, k1, k2, t)
    found = np.array([sample.intensities(annulus) for annulus in PARTS])
    assert np.ptp(found, axis=0).max() < spread
    assert np.abs(found - (k1, k2)).max() < error


@pytest.mark.parametrize(("n", "bound"), [(40, 2e-4), (60, 1.1e-4)])
@pytest.mark.parametrize(("k1", "k2"), MODES)
def test_j_does_not_depend_on_the_contour(n, bound, k1, k2):
    sample = Sample(n, k1, k2, 1.0)
    found = [sample.j(annulus) for annulus in PARTS]
    assert np.ptp(found) < bound
    assert found == pytest.approx([k1**2 + k2**2] * 3, rel=bound)


def test_a_small_rotation_adds_nothing():
    sample = Sample(60, 0.8, 0.6)
    before = sample.intensities()
    sample.H += np.array([[0.0], [-0.02], [0.02], [0.0]])
    assert sample.intensities() == pytest.approx(before, abs=1e-4)


@pytest.mark.parametrize("angle", [0.2, -1.0])
def test_a_large_rotation_does_not_change_j(angle):
    """F → R F and P → R P, which is no longer symmetric."""
    sample = Sample(120, 0.8, 0.6)
    before, psi = sample.j(), 0.5 * np.sum(sample.P * sample.H, axis=0)
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    identity = np.eye(2)[:, :, None]
    F = np.einsum("ij,jkm->ikm", rotation, sample.H.reshape(2, 2, -1) + identity)
    P = np.einsum("ij,jkm->ikm", rotation, sample.P.reshape(2, 2, -1))
    H = (F - identity).reshape(4, -1)
    j = j_integral(sample.x, sample.y, sample.volume, P.reshape(4, -1), H, psi, WHOLE, 0.0)
    assert j / (K**2 / E) == pytest.approx(before, rel=1e-3)


def test_the_integrals_are_those_of_the_formulas_for_any_tensors(rng):
    x, y = rng.uniform(-0.08, 0.08, (2, 500))
    volume, psi = rng.random((2, 500))
    P, H = rng.normal(size=(2, 2, 2, 500))
    slopes = np.array(weight_gradient(x, y, WHOLE, 0.0))
    flat = (x, y, volume, P.reshape(4, -1), H.reshape(4, -1))
    j = np.einsum("m,ijm,im,jm", volume, P, H[:, 0], slopes) - np.sum(volume * psi * slopes[0])
    assert j_integral(*flat, psi, WHOLE, 0.0) == pytest.approx(j, rel=1e-9)
    for mode, found in zip((1, 2), stress_intensities(*flat, WHOLE, 0.0, E, NU), strict=True):
        gradient = np.reshape(williams.displacement_gradient(mode, x, y, 1.0, E, NU), (2, 2, -1))
        strain = 0.5 * (gradient + gradient.transpose(1, 0, 2))
        xx, yy, xy = williams.stress(mode, x, y, 1.0)
        stress = np.array([[xx, xy], [xy, yy]])
        interaction = np.einsum("m,ijm,im,jm", volume, P, gradient[:, 0], slopes)
        interaction += np.einsum("m,ijm,im,jm", volume, stress, H[:, 0], slopes)
        interaction -= np.einsum("m,ikm,ikm,m", volume, P, strain, slopes[0])
        assert found == pytest.approx(0.5 * E * interaction, rel=1e-9)


def test_everything_moves_with_the_tip():
    sample = Sample(40, 0.8, 0.6)
    assert sample.intensities(tip_x=0.013) == pytest.approx(sample.intensities(), rel=1e-9)
    assert sample.j(tip_x=0.013) == pytest.approx(sample.j(), rel=1e-9)


def test_only_the_annulus_is_read():
    sample = Sample(40, 0.8, 0.6)
    before = sample.intensities(), sample.j()
    r = np.hypot(sample.x, sample.y)
    outside = (r < WHOLE.inner) | (r > WHOLE.outer)
    sample.P[:, outside] = np.nan
    sample.H[:, outside] = np.inf
    assert sample.intensities() == pytest.approx(before[0], rel=1e-15)
    assert sample.j() == pytest.approx(before[1], rel=1e-15)


def test_an_annulus_between_the_particles_is_refused():
    sample = Sample(40, 1.0, 0.0)
    with pytest.raises(ValueError, match=r"no particles between 0\.001 m and 0\.002 m"):
        sample.intensities(Annulus(1e-3, 2e-3))
    with pytest.raises(ValueError, match="no particles"):
        sample.j(Annulus(1e-3, 2e-3))


@pytest.mark.parametrize("angle", [0.0, 1.0, -2.5, np.pi])
def test_the_weight_falls_from_one_to_zero_along_every_ray(angle):
    r = np.linspace(0.0, 0.1, 2001)
    x, y = r * np.cos(angle), r * np.sin(angle)
    q_x, q_y = weight_gradient(x + 0.3, y, WHOLE, 0.3)
    along = q_x * np.cos(angle) + q_y * np.sin(angle)
    assert np.trapezoid(along, r) == pytest.approx(-1.0, abs=1e-12)
    assert np.abs(q_x * np.sin(angle) - q_y * np.cos(angle)).max() < 1e-9
    assert not along[(r < 0.02) | (r > 0.08)].any()


def test_an_annulus_fits_or_says_why_not():
    assert fits(Annulus(0.02, 0.08), clearance=0.02, edge=0.08) == ""
    # 0.1 - 2 · 0.005 rounded either way.
    assert fits(Annulus(0.02, 0.09), 0.02 * (1 + 1e-15), 0.09 * (1 - 1e-15)) == ""
    complaints = {
        Annulus(0.05, 0.05): "outer radius 0.05 m: must be greater than the inner radius, 0.05 m",
        Annulus(0.01, 0.05): "inner radius 0.01 m: must be at least 0.02 m, or particles see the tip",
        Annulus(0.03, 0.09): "outer radius 0.09 m: must be at most 0.08 m, where particles are driven",
    }
    for annulus, complaint in complaints.items():
        assert fits(annulus, clearance=0.02, edge=0.08) == complaint
    assert all(fits(a, 0.02, 0.08) for a in itertools.product([np.nan, 0.03], repeat=2))
