"""Visibility on hand-made cases, the degenerate ones included, and nodes that float."""

import numpy as np
import pytest

from sphstudy.numerics.sph.crack import TOLERANCE, Crack, crosses, line_of_sight, visible

NODES_X, NODES_Y = np.array([-2.0, -1.0, 0.0]), np.zeros(3)


@pytest.mark.parametrize(
    ("pair", "hidden"),
    [
        ((-1.5, -1.0, -1.5, 1.0), True),  # straight through the middle of a segment
        ((-1.0, -0.5, -1.0, 0.5), True),  # through an inner node
        ((0.0, -0.5, 0.0, 0.5), True),  # through the tip node
        ((-2.0, -0.5, -2.0, 0.5), True),  # through the first node
        ((1.0, 0.5, -1.0, -0.5), True),  # symmetric about the tip node
        ((0.01, -0.5, 0.01, 0.5), False),  # just ahead of the tip
        ((-1.5, 0.1, -1.5, 1.0), False),  # on one side
        ((-1.5, 0.2, -0.5, 0.2), False),  # parallel to the crack
        ((-1.5, 0.0, -0.5, 0.0), False),  # along the crack: parallel, does not meet it
        ((0.5, -0.5, 0.5, 0.5), False),  # past the end
    ],
)
def test_who_sees_whom(pair, hidden):
    assert visible(*pair, NODES_X, NODES_Y, TOLERANCE) is not hidden


def test_exclusive_test_lets_pairs_through_a_node():
    assert visible(0.0, -0.5, 0.0, 0.5, NODES_X, NODES_Y, -TOLERANCE)
    assert visible(-1.0, -0.5, -1.0, 0.5, NODES_X, NODES_Y, -TOLERANCE)
    assert not visible(-0.5, -0.5, -0.5, 0.5, NODES_X, NODES_Y, -TOLERANCE)


def test_tolerance_decides_about_rounding_not_about_geometry():
    nudge = 1e-12
    assert crosses(nudge, -0.5, nudge, 0.5, -1.0, 0.0, 0.0, 0.0, TOLERANCE)
    assert not crosses(1e-6, -0.5, 1e-6, 0.5, -1.0, 0.0, 0.0, 0.0, TOLERANCE)


def test_crossing_is_symmetric_and_moves_along(rng):
    for _ in range(200):
        a, b, p, q, shift = rng.normal(size=(5, 2))
        answer = crosses(*a, *b, *p, *q, TOLERANCE)
        assert crosses(*b, *a, *q, *p, TOLERANCE) == answer
        assert crosses(*(a + shift), *(b + shift), *(p + shift), *(q + shift), TOLERANCE) == answer


def test_nodes_float_half_way_between_their_particles():
    x, y = np.array([0.0, 0.0, 2.0, 3.0]), np.array([-1.0, 1.0, -1.0, 2.0])
    crack = Crack(np.array([0, 2]), np.array([1, 3]))
    _, _, node_x, node_y, *_ = line_of_sight(crack, x, y)
    np.testing.assert_array_equal(node_x, [0.0, 2.5])
    np.testing.assert_array_equal(node_y, [0.0, 0.5])
    _, _, moved_x, moved_y, *_ = line_of_sight(crack, x + 10.0, y - 3.0)
    np.testing.assert_array_equal(moved_x, node_x + 10.0)
    np.testing.assert_array_equal(moved_y, node_y - 3.0)


def test_frozen_sight_ignores_motion():
    x, y = np.array([0.0, 0.0]), np.array([-1.0, 1.0])
    crack = Crack(np.array([0]), np.array([1]), TOLERANCE, np.array([x, y]))
    seen_x, _, node_x, *_ = line_of_sight(crack, x + 5.0, y)
    np.testing.assert_array_equal(seen_x, x)
    np.testing.assert_array_equal(node_x, [0.0])
