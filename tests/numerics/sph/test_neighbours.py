"""The neighbour list against scipy's k-d tree, before and after motion, with and without a crack."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from sphstudy.numerics.sph import neighbours
from sphstudy.numerics.sph.crack import Crack, line_of_sight, visible
from tests.numerics.sph.clouds import lattice_positions, middle_crack, random_cloud


def tree_pairs(x, y, reach, crack=None):
    """All pairs i < j closer than `reach` that see each other."""
    found = cKDTree(np.array([x, y]).T).query_pairs(reach)
    seen_x, seen_y, *nodes, tolerance, _ = line_of_sight(crack, x, y)
    return {
        (i, j)
        for i, j in found
        if crack is None or visible(seen_x[i], seen_y[i], seen_x[j], seen_y[j], *nodes, tolerance)
    }


def built(x, y, support, skin, crack=None):
    """A list, brought up to date with the configuration it was built for."""
    pairs = neighbours.build(x, y, support, skin, crack)
    neighbours.look(pairs, x, y, crack)
    return pairs


def listed_pairs(pairs, x, y, reach):
    """Pairs of the list closer than `reach`: without those that bridge gaps, or sit in the skin."""
    first, second = neighbours.as_pairs(pairs)
    close = (x[first] - x[second]) ** 2 + (y[first] - y[second]) ** 2 < reach**2
    kept = [(min(i, j), max(i, j)) for i, j in zip(first[close], second[close], strict=True)]
    assert len(set(kept)) == len(kept), "a pair stands twice"
    return {(int(i), int(j)) for i, j in kept}


@pytest.mark.parametrize("shape", ["cloud", "lattice", "shuffled lattice"])
@pytest.mark.parametrize("cracked", [False, True])
def test_finds_exactly_the_pairs_of_a_k_d_tree(rng, shape, cracked):
    positions = random_cloud(rng) if shape == "cloud" else lattice_positions(12, 10)
    if shape == "shuffled lattice":
        positions = positions[:, rng.permutation(positions.shape[1])]
    x, y = positions
    crack = middle_crack(positions) if cracked else None
    pairs = built(x, y, 3.0, 0.1, crack)
    assert listed_pairs(pairs, x, y, 3.1) == tree_pairs(x, y, 3.1, crack)
    assert pairs.total >= len(tree_pairs(x, y, 3.1, crack))


def test_a_lattice_is_nearly_all_runs():
    x, y = lattice_positions(40, 10)
    pairs = built(x, y, 3.0, 0.1)
    assert pairs.first.size < 0.05 * pairs.total
    assert pairs.start.size < 60


def test_bridged_pairs_are_out_of_reach():
    x, y = lattice_positions(20, 10)
    pairs = built(x, y, 3.0, 0.1)
    first, second = neighbours.as_pairs(pairs)
    distance = np.hypot(x[first] - x[second], y[first] - y[second])
    assert np.count_nonzero(distance >= 3.1) > 0, "the lattice should have bridged some row ends"
    assert np.count_nonzero(distance < 3.1) == pairs.total


def test_a_run_never_bridges_a_pair_that_the_crack_hides(rng):
    positions = lattice_positions(30, 12)
    x, y = positions
    middle = np.flatnonzero(y == 5.0)
    crack = Crack(middle[:15], middle[:15] + 30)
    pairs = built(x, y, 3.0, 0.1, crack)
    assert listed_pairs(pairs, x, y, 3.1) == tree_pairs(x, y, 3.1, crack)


def test_no_pair_is_missed_until_the_list_is_outdated(rng):
    support, skin = 3.0, 0.3
    x, y = random_cloud(rng, 80)
    pairs = built(x, y, support, skin)
    rebuilds = 0
    for _ in range(60):
        x, y = x + rng.normal(scale=0.02, size=x.size), y + rng.normal(scale=0.02, size=x.size)
        if neighbours.outdated(pairs, x, y, 0.0):
            pairs = built(x, y, support, skin)
            rebuilds += 1
        assert tree_pairs(x, y, support) <= listed_pairs(pairs, x, y, support + 2 * skin)
    assert 0 < rebuilds < 60


@pytest.mark.parametrize("tolerance", [1e-9, -1e-9], ids=["inclusive", "exclusive"])
@pytest.mark.parametrize("shape", ["cloud", "lattice"])
def test_sight_is_exact_at_every_moment_between_two_builds(rng, shape, tolerance):
    """Watched pairs: whatever the crack cuts or frees while a list is good is noticed at once."""
    support, skin = 2.6, 0.4
    changes = 0
    for _ in range(12):
        x, y = random_cloud(rng, 80) if shape == "cloud" else lattice_positions(10, 8)
        crack = middle_crack(np.array([x, y]))._replace(tolerance=tolerance)
        pairs = built(x, y, support, skin, crack)
        before = listed_pairs(pairs, x, y, support)
        assert before == tree_pairs(x, y, support, crack)
        drift = rng.normal(scale=0.03, size=(2, x.size))
        while not neighbours.outdated(pairs, x, y, 0.0):
            neighbours.look(pairs, x, y, crack)
            seen = listed_pairs(pairs, x, y, support)
            assert seen == tree_pairs(x, y, support, crack)
            changes += len(seen ^ before)
            before = seen
            x, y = x + drift[0], y + drift[1]
    assert changes > 20, "the test should see many changes of sight"


def test_a_straight_crack_leaves_few_pairs_in_doubt():
    positions = lattice_positions(40, 20)
    x, y = positions
    below = np.flatnonzero(y == 9.0)[:20]
    pairs = built(x, y, 3.0, 0.15, Crack(below, below + 40))
    assert 0 < pairs.watched_first.size < 0.02 * pairs.total


def test_outdated_is_about_half_the_skin():
    x, y = lattice_positions(4, 4)
    pairs = built(x, y, 1.4, 0.1)
    for moved, answer in ((0.0499, False), (0.0501, True)):
        shifted = x.copy()
        shifted[5] += moved
        assert neighbours.outdated(pairs, shifted, y, 0.0) == answer


def test_outdated_reckons_with_the_next_stride():
    x, y = lattice_positions(4, 4)
    pairs = built(x, y, 1.4, 0.1)
    assert not neighbours.outdated(pairs, x, y, 0.05)
    assert neighbours.outdated(pairs, x, y, 0.0501)
    assert neighbours.outdated(pairs, x, y, np.nan)


def test_positions_that_are_not_finite_neither_crash_nor_have_neighbours():
    x, y = lattice_positions(6, 6)
    x[7], y[9], x[11] = np.nan, np.inf, 1e100
    pairs = built(x, y, 1.9, 0.1)
    first, second = neighbours.as_pairs(pairs)
    close = np.hypot(x[first] - x[second], y[first] - y[second]) < 2.0
    assert not {7, 9, 11} & {*first[close], *second[close]}
