"""Bonds against a brute-force twin over all pairs, and cracks against exact geometry on a lattice."""

from fractions import Fraction

import numpy as np
import pytest

from sphstudy.numerics.sph import bonds
from sphstudy.numerics.sph.bonds import SHORTEST_RUN, Bonds, as_pairs
from sphstudy.numerics.sph.crack import TOLERANCE, Crack
from sphstudy.numerics.sph.kernel import KERNELS
from tests.numerics.sph import brute_force
from tests.numerics.sph.clouds import lattice_positions, middle_crack, random_cloud

SMOOTHING_LENGTH = 1.3
COLUMNS, ROWS = 11, 6

every_kernel = pytest.mark.parametrize("shape", KERNELS.values(), ids=KERNELS)


def cloud(rng, count=60):
    """Positions [2, N] and unequal volumes [N] of a random cloud."""
    return random_cloud(rng, count), rng.uniform(0.5, 1.5, count)


def lattice():
    """The same of a lattice whose volumes differ from row to row: its bonds form runs along the rows."""
    positions = lattice_positions(COLUMNS, ROWS)
    return positions, 1.0 + 0.1 * positions[1]


def mixed(rng):
    """The same of a lattice of which a few particles are out of place: runs, short runs and singles."""
    positions, volume = lattice()
    strays = rng.permutation(volume.size)[:8]
    positions[:, strays] += rng.uniform(-0.3, 0.3, (2, strays.size))
    return positions, volume


def named(body, rng):
    return {"cloud": cloud, "lattice": lambda _: lattice(), "mixed": mixed}[body](rng)


def twin(positions, volume, shape, crack):
    """w [N, N], zero where there is no bond, and X_j - X_i [2, N, N], from the definitions."""
    apart = positions[:, None, :] - positions[:, :, None]
    distance = np.hypot(*apart)
    near = (distance < shape.support * SMOOTHING_LENGTH) & brute_force.sees(*positions, crack)
    np.fill_diagonal(near, False)
    safe = np.where(near, distance, 1.0)
    slope = brute_force.kernel_slope(shape, safe, SMOOTHING_LENGTH)
    return np.where(near, -np.outer(volume, volume) * slope / safe, 0.0), apart


def built(positions, volume, shape, crack=None):
    return bonds.build(*positions, volume, shape, SMOOTHING_LENGTH, crack)


def listed(found):
    """The bonds as a set of pairs i < j, each of which must stand only once."""
    pairs = as_pairs(found)
    assert (pairs.first < pairs.second).all()
    unique = {(int(i), int(j)) for i, j in zip(pairs.first, pairs.second, strict=True)}
    assert len(unique) == pairs.first.size == found.total, "a pair stands twice"
    return unique


@every_kernel
@pytest.mark.parametrize("body", ["cloud", "lattice", "mixed"])
@pytest.mark.parametrize("cracked", [False, True], ids=["whole", "cracked"])
def test_equal_the_brute_force_twin(rng, body, shape, cracked):
    positions, volume = named(body, rng)
    crack = middle_crack(positions) if cracked else None
    found = built(positions, volume, shape, crack)
    weight, apart = twin(positions, volume, shape, crack)
    assert listed(found) == set(zip(*(np.nonzero(np.triu(weight))), strict=True))
    pairs = as_pairs(found)
    i, j = pairs.first, pairs.second
    np.testing.assert_allclose(pairs.weight, weight[i, j], rtol=0.0, atol=1e-13 * weight.max())
    np.testing.assert_allclose([pairs.x, pairs.y], apart[:, i, j], rtol=0.0, atol=1e-13)


@every_kernel
def test_a_lattice_is_all_runs_and_a_cloud_all_singles(rng, shape):
    found = built(*lattice(), shape)
    assert found.first.size == 0
    assert found.length.min() >= SHORTEST_RUN
    found = built(*cloud(rng), shape)
    assert found.length.size == 0
    found = built(*mixed(rng), shape)
    assert found.first.size > 0
    assert found.length.size > 0


def test_equal_volumes_let_runs_go_on_from_row_to_row():
    positions, volume = lattice()
    found = built(positions, np.ones_like(volume), KERNELS["cubic"])
    upright = found.offset == COLUMNS
    np.testing.assert_array_equal(found.length[upright], [COLUMNS * (ROWS - 1)])


def test_rounding_of_the_coordinates_does_not_end_a_run():
    positions, volume = lattice()
    scaled = 0.1 * positions + 7.3
    found = bonds.build(*scaled, volume, KERNELS["cubic"], 0.1 * SMOOTHING_LENGTH, None)
    assert np.unique(np.diff(scaled[0, :COLUMNS])).size > 1, "the spacings should differ by rounding"
    assert found.first.size == 0


@pytest.mark.parametrize("difference", ["volume", "position"])
def test_differences_beyond_rounding_end_a_run(rng, difference):
    """Even small ones: within a run all bonds share one weight and one vector."""
    positions, volume = lattice()
    small = 1e-8 * rng.uniform(-1.0, 1.0, positions.shape)
    if difference == "volume":
        volume = volume + small[0]
    else:
        positions = positions + small
    found = built(positions, volume, KERNELS["cubic"])
    weight, apart = twin(positions, volume, KERNELS["cubic"], None)
    pairs = as_pairs(found)
    i, j = pairs.first, pairs.second
    np.testing.assert_allclose(pairs.weight, weight[i, j], rtol=0.0, atol=1e-10 * weight.max())
    np.testing.assert_allclose([pairs.x, pairs.y], apart[:, i, j], rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("turned", [False, True], ids=["along x", "along y"])
def test_equal_weights_make_no_run_of_different_vectors(turned):
    """Two rows whose particles face each other aslant, now to one side and now to the other."""
    along = 2.0 * np.arange(10.0)
    row = np.stack((along, np.zeros(10)))
    facing = np.stack((along + np.tile((0.4, -0.4), 5), np.ones(10)))
    positions = np.concatenate((row, facing), axis=1)
    positions = positions[::-1] if turned else positions
    found = built(positions, np.ones(20), KERNELS["cubic"])
    _, apart = twin(positions, np.ones(20), KERNELS["cubic"], None)
    pairs = as_pairs(found)
    assert {(i, i + 10) for i in range(10)} < listed(found)
    np.testing.assert_allclose([pairs.x, pairs.y], apart[:, pairs.first, pairs.second], atol=1e-13)


def crossings(pairs, level):
    """Where each pair of lattice particles crosses a height between two rows, exactly; else None."""
    found = {}
    for i, j in pairs:
        (row, column), (other_row, other_column) = divmod(i, COLUMNS), divmod(j, COLUMNS)
        if row < level < other_row:
            rise = Fraction(other_column - column, other_row - row)
            found[i, j] = column + rise * (level - row)
    return found


@every_kernel
@pytest.mark.parametrize("tolerance", [TOLERANCE, -TOLERANCE], ids=["inclusive", "exclusive"])
def test_a_crack_cuts_exactly_the_pairs_that_cross_it(shape, tolerance):
    """Half-way between two rows, from x = 3 to its tip at x = 8."""
    positions, volume = lattice()
    below = 2 * COLUMNS + np.arange(3, 9)
    crack = Crack(below, below + COLUMNS, tolerance)
    whole, cracked = (listed(built(positions, volume, shape, c)) for c in (None, crack))
    assert cracked < whole
    across = crossings(whole, Fraction(5, 2))
    if tolerance > 0.0:
        expected = {pair for pair, x in across.items() if 3 <= x <= 8}
    else:
        expected = {pair for pair, x in across.items() if 3 < x < 8 and x.denominator > 1}
    assert whole - cracked == expected
    # What rounding would otherwise decide: the pair that carries the tip, and one symmetric about it.
    tip, slanted = (below[-1], below[-1] + COLUMNS), (below[-1] - 1, below[-1] + COLUMNS + 1)
    for pair in (tip, slanted):
        assert across[pair] == 8
        assert (pair in cracked) == (tolerance < 0.0)
    assert (below[-1] + 1, below[-1] + COLUMNS + 1) in cracked


@every_kernel
def test_particles_at_the_same_place_are_refused(rng, shape):
    positions, volume = cloud(rng)
    positions[:, 17] = positions[:, 42]
    with np.errstate(all="ignore"), pytest.raises(ValueError, match="same place"):
        built(positions, volume, shape)


def test_bonds_one_by_one_are_those_of_the_runs_and_then_the_singles():
    found = Bonds(
        start=np.array([3, 0]),
        offset=np.array([4, 10]),
        length=np.array([2, 4]),
        at=np.array([0, 2]),
        there=np.array([1, 1, 1, 1, 0, 1], np.uint8),
        run_weight=np.array([0.5, 0.25]),
        run_x=np.array([1.0, -1.0]),
        run_y=np.array([2.0, 0.0]),
        first=np.array([7]),
        second=np.array([9]),
        weight=np.array([0.125]),
        x=np.array([3.0]),
        y=np.array([-2.0]),
        run_begin=np.array([0, 2]),
        single_begin=np.array([0, 1]),
    )
    assert found.total == 6
    pairs = as_pairs(found)
    np.testing.assert_array_equal(pairs.first, [3, 4, 0, 1, 3, 7])
    np.testing.assert_array_equal(pairs.second, [7, 8, 10, 11, 13, 9])
    np.testing.assert_array_equal(pairs.weight, [0.5, 0.5, 0.25, 0.25, 0.25, 0.125])
    np.testing.assert_array_equal(pairs.x, [1.0, 1.0, -1.0, -1.0, -1.0, 3.0])
    np.testing.assert_array_equal(pairs.y, [2.0, 2.0, 0.0, 0.0, 0.0, -2.0])
