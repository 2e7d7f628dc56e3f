"""Contact: a force from a potential, between surfaces of different bodies or of a folded one."""

import numpy as np
import pytest

from sphstudy.numerics.sph import contact
from sphstudy.numerics.sph.contact import APART, SKIN, Surfaces

REACH = 2.5


@pytest.fixture
def two_rows(rng):
    """Two rows of particles, one body each, that come within reach of each other, slightly ruffled."""
    count = 12
    x = np.tile(np.arange(count, dtype=float), 2)
    y = np.repeat((0.0, 40.0), count)
    part = np.repeat((0, 1), count)
    surfaces = Surfaces(3.0, REACH, np.arange(2 * count), x, y, part)
    place = np.stack((x, np.where(part == 1, 1.7, 0.0))) + rng.uniform(-0.2, 0.2, (2, 2 * count))
    return surfaces, place


def forces(found, place):
    force = np.zeros_like(place)
    contact.add_forces(found, *place, force)
    return force


def test_force_is_the_gradient_of_the_energy(two_rows):
    surfaces, place = two_rows
    found = surfaces.contact(*place)
    force = forces(found, place)
    assert np.abs(force).max() > 1.0
    step = 1e-5
    for row, i in ((0, 3), (1, 3), (0, 17), (1, 20)):
        moved = [place.copy(), place.copy()]
        moved[0][row, i] += step
        moved[1][row, i] -= step
        slope = (contact.energy(found, *moved[0]) - contact.energy(found, *moved[1])) / (2.0 * step)
        assert force[row, i] == pytest.approx(-slope, rel=1e-7, abs=1e-8)


def test_against_all_pairs_one_by_one(two_rows):
    surfaces, place = two_rows
    expected, energy = np.zeros_like(place), 0.0
    for i in range(12):
        for j in range(12, 24):
            apart = place[:, j] - place[:, i]
            r = np.hypot(*apart)
            if r < REACH:
                push = 3.0 * 3.0 * REACH * (1.0 - r / REACH) ** 2 * apart / r
                expected[:, i] -= push
                expected[:, j] += push
                energy += 3.0 * REACH**2 * (1.0 - r / REACH) ** 3
    found = surfaces.contact(*place)
    np.testing.assert_allclose(forces(found, place), expected, rtol=1e-12, atol=1e-12)
    assert contact.energy(found, *place) == pytest.approx(energy, rel=1e-12)


def test_keeps_momentum_and_angular_momentum(two_rows):
    surfaces, place = two_rows
    force = forces(surfaces.contact(*place), place)
    assert np.abs(force.sum(axis=1)).max() < 1e-13 * np.abs(force).sum()
    assert abs((place[0] * force[1] - place[1] * force[0]).sum()) < 1e-12 * np.abs(force).sum()


def test_same_bits_whenever_the_pairs_were_looked_for(two_rows, rng):
    surfaces, place = two_rows
    near = place + rng.uniform(-0.1, 0.1, place.shape) * SKIN * REACH
    fresh, older = surfaces.contact(*place), surfaces.contact(*near)
    assert not np.array_equal(fresh.first, older.first), "the lists should differ"
    np.testing.assert_array_equal(forces(fresh, place), forces(older, place))
    assert contact.energy(fresh, *place) == contact.energy(older, *place)


def test_a_body_touches_itself_only_where_it_was_far_from_itself():
    """A strip folded onto itself: its ends meet, neighbours along it do not."""
    x, y = np.arange(20, dtype=float), np.zeros(20)
    surfaces = Surfaces(3.0, REACH, np.arange(20), x, y, None)
    folded_x, folded_y = np.where(x < 10, x, 19.0 - x), np.where(x < 10, 0.0, 1.5)
    found = surfaces.contact(folded_x, folded_y)
    assert (0, 19) in zip(found.first.tolist(), found.second.tolist(), strict=True)
    assert (found.second - found.first > APART * REACH).all()
    assert surfaces.contact(x, y).first.size == 0


def test_no_contact_adds_nothing():
    force = np.ones((2, 3))
    contact.add_forces(None, np.zeros(3), np.zeros(3), force)
    np.testing.assert_array_equal(force, 1.0)
    assert contact.energy(None, np.zeros(3), np.zeros(3)) == 0.0
