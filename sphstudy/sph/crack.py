"""Cracks: polylines whose nodes float half-way between pairs of particles (thesis 2.7)."""

from typing import NamedTuple

import numpy as np

from sphstudy.compilation import compiled_exactly

TOLERANCE = 1e-9
"""Widening of both segments in the visibility test, in units of their lengths.

The pair that carries a node, and every pair symmetric about it, passes *exactly* through the end of
a segment: without a tolerance, rounding decides about the crack tip.
"""


class Crack(NamedTuple):
    """Node k lies half-way between particles `first[k]` and `second[k]`; arrays of int64 [K].

    A negative tolerance makes the test exclusive. `frozen` [2, N]: positions (m) in which visibility is
    judged once and for all; None: in the current ones, again at every neighbour search.
    """

    first: np.ndarray
    second: np.ndarray
    tolerance: float = TOLERANCE
    frozen: np.ndarray | None = None


@compiled_exactly
def crosses(ax, ay, bx, by, px, py, qx, qy, tolerance):
    """Whether segment a-b meets segment p-q, ends included and widened by `tolerance`.

    Solves a + λ₁ (b - a) = p + λ₂ (q - p) and asks for both λ in [0, 1]. Parallel segments do not
    meet.
    """
    dx, dy = bx - ax, by - ay
    ex, ey = qx - px, qy - py
    determinant = ex * dy - dx * ey
    if determinant == 0.0:
        return False
    fx, fy = px - ax, py - ay
    along_pair = (ex * fy - ey * fx) / determinant
    along_crack = (dx * fy - dy * fx) / determinant
    low, high = -tolerance, 1.0 + tolerance
    return low <= along_pair <= high and low <= along_crack <= high


@compiled_exactly
def _judged(frozen, x, y):
    if frozen is None:
        return x, y
    return frozen[0], frozen[1]


@compiled_exactly
def line_of_sight(crack, x, y):
    """Positions in which visibility is judged, nodes of the polyline [K], and the tolerance."""
    if crack is None:
        return x, y, np.empty(0), np.empty(0), 0.0
    x, y = _judged(crack.frozen, x, y)
    count = crack.first.size
    node_x, node_y = np.empty(count), np.empty(count)
    for k in range(count):
        i, j = crack.first[k], crack.second[k]
        node_x[k] = 0.5 * (x[i] + x[j])
        node_y[k] = 0.5 * (y[i] + y[j])
    return x, y, node_x, node_y, crack.tolerance


@compiled_exactly
def visible(ax, ay, bx, by, node_x, node_y, tolerance):
    """Whether a and b see each other past the polyline through the nodes [K]."""
    for k in range(node_x.size - 1):
        if crosses(ax, ay, bx, by, node_x[k], node_y[k], node_x[k + 1], node_y[k + 1], tolerance):
            return False
    return True
