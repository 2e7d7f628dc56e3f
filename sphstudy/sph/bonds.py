"""Bonds of a total Lagrangian method: pairs of particles that interact in the reference configuration.

Each unordered pair stands once, with its weight w = V_i V_j (-W'(R)/R) and its reference vector
X_j - X_i, which never change. Where consecutive particles have a bond to the same distance in memory with
the same vector and weight, as on any lattice stored row by row, the bonds form a *run* with one weight
and one vector; all others are *single*. A lattice is nearly all runs, a random cloud all singles.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.compilation import compiled_exactly
from sphstudy.sph import kernel, neighbours
from sphstudy.sph.crack import Crack, line_of_sight, visible
from sphstudy.sph.kernel import Kernel

SHORTEST_RUN = 8
"""Shorter runs go to the singles: their set-up costs more than they save."""

ALIKE = 1e-11
"""Relative difference of weights and vectors within a run: rounding of lattice coordinates."""


class Bonds(NamedTuple):
    """Runs: bonds (start + k, start + offset + k), k < length, all with the same weight w (a pure number)
    and reference vector run_x, run_y (m). Singles: (first, second) with weight, x, y.
    """

    start: np.ndarray
    offset: np.ndarray
    length: np.ndarray
    run_weight: np.ndarray
    run_x: np.ndarray
    run_y: np.ndarray
    first: np.ndarray
    second: np.ndarray
    weight: np.ndarray
    x: np.ndarray
    y: np.ndarray

    @property
    def total(self) -> int:
        """How many bonds there are."""
        return int(self.length.sum()) + self.first.size


@compiled_exactly
def _in_sight(x, y, first, second, crack):
    """For each pair whether the particles see each other past the crack; x, y [N] (m)."""
    x, y, node_x, node_y, tolerance, _ = line_of_sight(crack, x, y)
    seen = np.ones(first.size, np.bool_)
    for p in range(first.size):
        i, j = first[p], second[p]
        seen[p] = visible(x[i], y[i], x[j], y[j], node_x, node_y, tolerance)
    return seen


@compiled_exactly
def _weights(x, y, volume, first, second, shape, smoothing_length, normalisation):
    """w, X_j - X_i and Y_j - Y_i of each pair."""
    weight, along, across = np.empty(first.size), np.empty(first.size), np.empty(first.size)
    for p in range(first.size):
        i, j = first[p], second[p]
        along[p], across[p] = x[j] - x[i], y[j] - y[i]
        distance = np.hypot(along[p], across[p])
        slope = kernel.slope(shape, distance / smoothing_length) * normalisation / smoothing_length
        weight[p] = -volume[i] * volume[j] * slope / distance
    return weight, along, across


@compiled_exactly
def _runs(first, second, weight, x, y, heaviest, farthest):
    """Begin and length of the runs among the sorted pairs, and a mask of the pairs in none."""
    total = first.size
    begin = np.empty(total // SHORTEST_RUN + 1, np.int64)
    length = np.empty_like(begin)
    single = np.zeros(total, np.bool_)
    runs = 0
    low = 0
    while low < total:
        high = low + 1
        while (
            high < total
            and first[high] == first[high - 1] + 1
            and second[high] == second[high - 1] + 1
            and abs(weight[high] - weight[low]) <= ALIKE * heaviest
            and abs(x[high] - x[low]) <= ALIKE * farthest
            and abs(y[high] - y[low]) <= ALIKE * farthest
        ):
            high += 1
        if high - low >= SHORTEST_RUN:
            begin[runs], length[runs] = low, high - low
            runs += 1
        else:
            single[low:high] = True
        low = high
    return begin[:runs], length[:runs], single


def build(
    x: np.ndarray,
    y: np.ndarray,
    volume: np.ndarray,
    shape: Kernel,
    smoothing_length: float,
    crack: Crack | None,
) -> Bonds:
    """Bonds of the reference configuration x, y [N] (m), volumes [N] (m²): all pairs within the support
    of the kernel that see each other past the crack. Raises ValueError if two particles coincide.
    """
    support = shape.support * smoothing_length
    first, second = neighbours.close_pairs(x, y, support)
    if crack is not None:
        seen = _in_sight(x, y, first, second, crack)
        first, second = first[seen], second[seen]
    first, second = neighbours.sorted_by_offset(first, second, x.size)
    normalisation = shape.normalisation(smoothing_length)
    weight, along, across = _weights(x, y, volume, first, second, shape, smoothing_length, normalisation)
    if not np.isfinite(weight).all():
        raise ValueError("two particles stand at the same place")
    heaviest = float(weight.max(initial=0.0))
    begin, length, single = _runs(first, second, weight, along, across, heaviest, support)
    return Bonds(
        first[begin].astype(np.int64),
        (second[begin] - first[begin]).astype(np.int64),
        length.copy(),
        *(values[begin] for values in (weight, along, across)),
        *(values[single] for values in (first, second, weight, along, across)),
    )


class Pairs(NamedTuple):
    """Bonds one by one: particles [M], weight, and reference vector x, y (m)."""

    first: np.ndarray
    second: np.ndarray
    weight: np.ndarray
    x: np.ndarray
    y: np.ndarray


def as_pairs(bonds: Bonds) -> Pairs:
    """All bonds one by one, those of runs first."""
    along = np.arange(bonds.length.sum()) - np.repeat(
        np.cumsum(bonds.length) - bonds.length, bonds.length
    )
    first = np.repeat(bonds.start, bonds.length) + along
    return Pairs(
        np.concatenate((first, bonds.first)),
        np.concatenate((first + np.repeat(bonds.offset, bonds.length), bonds.second)),
        np.concatenate((np.repeat(bonds.run_weight, bonds.length), bonds.weight)),
        np.concatenate((np.repeat(bonds.run_x, bonds.length), bonds.x)),
        np.concatenate((np.repeat(bonds.run_y, bonds.length), bonds.y)),
    )
