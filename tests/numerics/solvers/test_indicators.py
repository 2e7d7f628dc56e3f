"""Indicators of a run going bad, on deformations whose answer is known."""

import numpy as np
import pytest

from sphstudy.model.lattice import lattice, lattice_sites
from sphstudy.model.material import Material
from sphstudy.model.problem import Body, Problem
from sphstudy.numerics.solvers.indicators import Indicators, cells, partners
from tests.numerics.sph.clouds import FREE

COLUMNS, ROWS, SPACING = 6, 5, 0.25


def body(**changes):
    x, y = lattice(SPACING * np.arange(COLUMNS), SPACING * np.arange(ROWS))
    steel = Material(1.0, 0.3, 1.0, "strain")
    values = {"sites": lattice_sites(COLUMNS, ROWS)} | changes
    return Body(x, y, np.ones(x.size), SPACING, SPACING, steel, {}, **values)


def looker(mirrors=("x", "y"), **changes):
    one = body(**changes)
    still = np.zeros(one.x.size)
    problem = Problem(one, FREE, (), SPACING, (1.0, 0.3), still, still, 0, mirrors=mirrors)
    return Indicators(problem), problem.start, one.sites


def checkerboard(sites, amplitude):
    sign = 1.0 - 2.0 * (sites.sum(axis=0) % 2)
    return amplitude * np.stack((sign, np.zeros(sign.size)))


def test_a_checkerboard_is_all_hourglass():
    indicators, place, sites = looker()
    seen = indicators.measure(place + checkerboard(sites, 0.1 * SPACING))
    assert seen.hourglass_share == pytest.approx(1.0, abs=1e-15)
    assert seen.hourglass_amplitude == pytest.approx(0.1, rel=1e-12)


def test_affine_motion_and_rotation_are_none():
    indicators, place, _ = looker()
    stretched = np.array([[1.2, 0.3], [-0.1, 0.9]]) @ place
    seen = indicators.measure(stretched)
    assert seen.hourglass_share < 1e-28
    assert seen.hourglass_amplitude < 1e-14
    c, s = np.cos(1.1), np.sin(1.1)
    turned = indicators.measure(np.array([[c, -s], [s, c]]) @ place)
    assert turned.hourglass_amplitude < 1e-14
    assert indicators.measure(place) == (0.0, 0.0, 0.0)


def test_share_of_both_together():
    """With |a|² of the checkerboard and a strain e in x alone: |a|² / (|a|² + (eΔ/2)²)."""
    indicators, place, sites = looker()
    strain, amplitude = 1e-7, 3e-8 * SPACING
    both = place + np.stack((strain * place[0], 0.0 * place[1])) + checkerboard(sites, amplitude)
    expected = amplitude**2 / (amplitude**2 + (0.5 * strain * SPACING) ** 2)
    assert indicators.measure(both).hourglass_share == pytest.approx(expected, rel=1e-6)


def test_mirror_defect_is_the_largest_distance_from_an_image():
    indicators, place, _ = looker()
    middle = place.mean(axis=1, keepdims=True)
    symmetric = middle + 1.3 * (place - middle)
    assert indicators.measure(symmetric).mirror_defect < 1e-14
    symmetric[:, 4] += (0.03 * SPACING, 0.04 * SPACING)
    assert indicators.measure(symmetric).mirror_defect == pytest.approx(0.05, rel=1e-10)


def test_a_shift_breaks_the_mirror_across_it_alone():
    for mirror, defect in (("x", 0.4), ("y", 0.0)):
        indicators, place, _ = looker((mirror,))
        moved = place + np.array([[0.2 * SPACING], [0.0]])
        assert indicators.measure(moved).mirror_defect == pytest.approx(defect, abs=1e-12)


def test_cells_lie_within_one_part():
    assert cells(body()).shape[1] == (COLUMNS - 1) * (ROWS - 1)
    halves = np.where(lattice_sites(COLUMNS, ROWS)[0] < 3, 0, 1)
    found = cells(body(part=halves))
    assert found.shape[1] == (COLUMNS - 2) * (ROWS - 1)
    assert (np.ptp(halves[found], axis=0) == 0).all()


def test_surface_is_the_rim_and_both_sides_of_a_seam():
    column, row = lattice_sites(COLUMNS, ROWS)
    rim = (column == 0) | (column == COLUMNS - 1) | (row == 0) | (row == ROWS - 1)
    np.testing.assert_array_equal(body().surface, rim)
    halves = np.where(column < 3, 0, 1)
    np.testing.assert_array_equal(body(part=halves).surface, rim | (column == 2) | (column == 3))


def test_without_a_lattice_there_is_nothing_to_say():
    indicators, place, _ = looker((), sites=None)
    assert np.isnan(indicators.measure(place)).all()
    with pytest.raises(ValueError, match="no mirror images"):
        partners(body(sites=None), "x")
    with pytest.raises(ValueError, match="surface"):
        assert body(sites=None).surface.any()


def test_a_mirror_that_the_lattice_lacks_is_named():
    sites = lattice_sites(COLUMNS, ROWS)
    sites[:, 0] = (-1, 0)
    with pytest.raises(ValueError, match="not symmetric in x"):
        looker(("x",), sites=sites)
