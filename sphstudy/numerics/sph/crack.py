"""Cracks: polylines whose nodes float half-way between pairs of particles (thesis 2.7)."""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled, compiled_inner

TOLERANCE = 1e-9
"""Widening of both segments in the visibility test, in units of their lengths.

The pair that carries a node, and every pair symmetric about it, passes *exactly* through the end of
a segment: without a tolerance, rounding decides about the crack tip.
"""

VISIBLE, HIDDEN, IN_DOUBT = range(3)


class Crack(NamedTuple):
    """Node k lies half-way between particles `first[k]` and `second[k]`; arrays of int64 [K].

    A negative tolerance makes the test exclusive. `frozen` [2, N]: positions (m) in which visibility is
    judged once and for all; None: in the current ones, again at every evaluation.
    """

    first: np.ndarray
    second: np.ndarray
    tolerance: float = TOLERANCE
    frozen: np.ndarray | None = None


@compiled_inner
def _crossing(ax, ay, bx, by, px, py, qx, qy):
    """λ₁, λ₂ of a + λ₁ (b - a) = p + λ₂ (q - p); infinite if the segments are parallel."""
    dx, dy = bx - ax, by - ay
    ex, ey = qx - px, qy - py
    determinant = ex * dy - dx * ey
    if determinant == 0.0:
        return np.inf, np.inf
    fx, fy = px - ax, py - ay
    return (ex * fy - ey * fx) / determinant, (dx * fy - dy * fx) / determinant


@compiled
def crosses(ax, ay, bx, by, px, py, qx, qy, tolerance):
    """Whether segment a-b meets segment p-q: both λ in [0, 1], widened by `tolerance` (thesis 2.7)."""
    along_pair, along_crack = _crossing(ax, ay, bx, by, px, py, qx, qy)
    low, high = -tolerance, 1.0 + tolerance
    return low <= along_pair <= high and low <= along_crack <= high


@compiled_inner
def _judged(frozen, x, y):
    if frozen is None:
        return x, y, False
    return frozen[0], frozen[1], True


@compiled
def line_of_sight(crack, x, y):
    """Positions in which visibility is judged, nodes of the polyline [K], tolerance, whether frozen."""
    if crack is None:
        return x, y, np.empty(0), np.empty(0), 0.0, True
    x, y, frozen = _judged(crack.frozen, x, y)
    node_x = 0.5 * (x[crack.first] + x[crack.second])
    node_y = 0.5 * (y[crack.first] + y[crack.second])
    return x, y, node_x, node_y, crack.tolerance, frozen


@compiled
def visible(ax, ay, bx, by, node_x, node_y, tolerance):
    """Whether a and b see each other past the polyline through the nodes [K]."""
    for k in range(node_x.size - 1):
        if crosses(ax, ay, bx, by, node_x[k], node_y[k], node_x[k + 1], node_y[k + 1], tolerance):
            return False
    return True


@compiled_inner
def _distance_squared(x, y, px, py, qx, qy):
    """From a point to the segment p-q."""
    dx, dy = qx - px, qy - py
    length_squared = dx * dx + dy * dy
    along = 0.0
    if length_squared > 0.0:
        along = min(max(((x - px) * dx + (y - py) * dy) / length_squared, 0.0), 1.0)
    return (x - px - along * dx) ** 2 + (y - py - along * dy) ** 2


@compiled
def outlook(ax, ay, bx, by, node_x, node_y, tolerance, margin):
    """What can become of the sight between a and b while nothing moves relative to them by `margin` (m).

    Returns (verdict, low, high): VISIBLE or HIDDEN for as long as that holds, or IN_DOUBT, with the
    range of segments that may come between them. In continuous motion a segment and a polyline gain or
    lose a *single* crossing only where an end of one passes through the other. So an odd number of
    crossings stays odd, hence hidden, while all four ends keep their distance. (To the exclusive test
    every node is such an end.)
    """
    last = node_x.size - 2
    near = margin * margin
    low, high, crossings = last + 1, 0, 0
    doubt = False
    left, right = min(ax, bx) - margin, max(ax, bx) + margin
    bottom, top = min(ay, by) - margin, max(ay, by) + margin
    for k in range(last + 1):
        px, py, qx, qy = node_x[k], node_y[k], node_x[k + 1], node_y[k + 1]
        if max(px, qx) < left or min(px, qx) > right or max(py, qy) < bottom or min(py, qy) > top:
            continue
        along_pair, along_crack = _crossing(ax, ay, bx, by, px, py, qx, qy)
        crossed = 0.0 <= along_pair <= 1.0 and 0.0 <= along_crack < 1.0
        p_near = _distance_squared(px, py, ax, ay, bx, by) <= near
        q_near = _distance_squared(qx, qy, ax, ay, bx, by) <= near
        a_near = _distance_squared(ax, ay, px, py, qx, qy) <= near
        b_near = _distance_squared(bx, by, px, py, qx, qy) <= near
        if crossed or p_near or q_near or a_near or b_near:
            low, high = min(low, k), k + 1
        crossings += crossed
        open_left, open_right = k == 0 or tolerance < 0.0, k == last or tolerance < 0.0
        doubt |= a_near or b_near or (open_left and p_near) or (open_right and q_near)
    if low >= high:
        return VISIBLE, 0, 0
    if crossings % 2 == 1 and not doubt:
        return HIDDEN, 0, 0
    return IN_DOUBT, low, high
