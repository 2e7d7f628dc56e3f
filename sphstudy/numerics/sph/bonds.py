"""Bonds of a total Lagrangian method: pairs of particles that interact in the reference configuration.

Each unordered pair stands once, with its weight w = V_i V_j (-W'(R)/R) and its reference vector
X_j - X_i, which never change. Where consecutive particles have a bond to the same distance in memory with
the same vector and weight, as on any lattice stored row by row, the bonds form a *run*, over which loops
vectorise; all others are *single*. A run goes on over a few bonds that are missing, at the end of a row
or across a crack. A lattice is nearly all runs, a random cloud all singles.

Bonds are kept by blocks of particles (see sph.pair_blocks).
"""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled
from sphstudy.numerics.sph import kernel, neighbours, pair_blocks
from sphstudy.numerics.sph.crack import Crack, line_of_sight, visible
from sphstudy.numerics.sph.kernel import Kernel

SHORTEST_RUN = 8
"""Shorter runs go to the singles: their set-up costs more than they save."""

LONGEST_GAP = 16
"""A run goes on over up to so many missing bonds: cheaper than starting another one."""

ALIKE = 1e-11
"""Relative difference of weights and vectors within a run: rounding of lattice coordinates."""


class Bonds(NamedTuple):
    """Runs: bonds (start + k, start + offset + k), k < length, wherever there[at + k] is 1, not 0, with
    one weight run_weight (a pure number) and reference vector run_x, run_y (m). Singles: (first, second)
    with weight, x, y.

    Block b holds the runs and singles from run_begin[b], single_begin[b] up to the next block's.
    """

    start: np.ndarray
    offset: np.ndarray
    length: np.ndarray
    at: np.ndarray
    there: np.ndarray
    run_weight: np.ndarray
    run_x: np.ndarray
    run_y: np.ndarray
    first: np.ndarray
    second: np.ndarray
    weight: np.ndarray
    x: np.ndarray
    y: np.ndarray
    run_begin: np.ndarray
    single_begin: np.ndarray

    @property
    def total(self) -> int:
        """How many bonds there are."""
        return int(np.count_nonzero(self.there)) + self.first.size


@compiled
def _in_sight(x, y, first, second, crack):
    """For each pair whether the particles see each other past the crack; x, y [N] (m)."""
    x, y, node_x, node_y, tolerance, _ = line_of_sight(crack, x, y)
    seen = np.ones(first.size, np.bool_)
    for p in range(first.size):
        i, j = first[p], second[p]
        seen[p] = visible(x[i], y[i], x[j], y[j], node_x, node_y, tolerance)
    return seen


@compiled
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


@compiled
def _runs(first, second, weight, x, y, heaviest, farthest, size):
    """Begin and end of the runs among the sorted pairs, and a mask of the pairs in none."""
    total = first.size
    begin = np.empty(total // SHORTEST_RUN + 1, np.int64)
    end = np.empty_like(begin)
    single = np.zeros(total, np.bool_)
    runs = 0
    low = 0
    while low < total:
        high = low + 1
        while (
            high < total
            and second[high] - first[high] == second[low] - first[low]
            and 0 < first[high] - first[high - 1] <= LONGEST_GAP + 1
            and first[high] // size == first[low] // size
            and abs(weight[high] - weight[low]) <= ALIKE * heaviest
            and abs(x[high] - x[low]) <= ALIKE * farthest
            and abs(y[high] - y[low]) <= ALIKE * farthest
        ):
            high += 1
        if high - low >= SHORTEST_RUN:
            begin[runs], end[runs] = low, high
            runs += 1
        else:
            single[low:high] = True
        low = high
    return begin[:runs], end[:runs], single


@compiled
def _there(first, begin, end, at, total):
    """Along the runs, one after another, 1 where there is a bond and 0 where it is missing."""
    found = np.zeros(total, np.uint8)
    for r in range(begin.size):
        for p in range(begin[r], end[r]):
            found[at[r] + first[p] - first[begin[r]]] = 1
    return found


def build(
    x: np.ndarray,
    y: np.ndarray,
    volume: np.ndarray,
    shape: Kernel,
    smoothing_length: float,
    crack: Crack | None,
    part: np.ndarray | None = None,
) -> Bonds:
    """Bonds of the reference configuration x, y [N] (m), volumes [N] (m²): all pairs within the support
    of the kernel that belong to the same part [N], if several are told apart, and see each other past
    the crack. Raises ValueError if two particles coincide.
    """
    support = shape.support * smoothing_length
    first, second = neighbours.close_pairs(x, y, support)
    if part is not None:
        same = part[first] == part[second]
        first, second = first[same], second[same]
    if crack is not None:
        seen = _in_sight(x, y, first, second, crack)
        first, second = first[seen], second[seen]
    size = neighbours.block_size(first, second)
    first, second = neighbours.sorted_by_offset(first, second, x.size, size)
    normalisation = shape.normalisation(smoothing_length)
    weight, along, across = _weights(x, y, volume, first, second, shape, smoothing_length, normalisation)
    if not np.isfinite(weight).all():
        raise ValueError("two particles stand at the same place")
    heaviest = float(weight.max(initial=0.0))
    begin, end, single = _runs(first, second, weight, along, across, heaviest, support, size)
    start = first[begin].astype(np.int64)
    length = first[end - 1] - start + 1
    at = np.cumsum(length) - length
    return Bonds(
        start=start,
        offset=second[begin] - start,
        length=length,
        at=at,
        there=_there(first, begin, end, at, int(length.sum())),
        run_weight=weight[begin],
        run_x=along[begin],
        run_y=across[begin],
        first=first[single],
        second=second[single],
        weight=weight[single],
        x=along[single],
        y=across[single],
        run_begin=pair_blocks.begins(start, size, x.size),
        single_begin=pair_blocks.begins(first[single], size, x.size),
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
    along = np.arange(bonds.there.size) - np.repeat(bonds.at, bonds.length)
    first = np.repeat(bonds.start, bonds.length) + along
    there = bonds.there.astype(bool)
    runs = (
        first,
        first + np.repeat(bonds.offset, bonds.length),
        np.repeat(bonds.run_weight, bonds.length),
        np.repeat(bonds.run_x, bonds.length),
        np.repeat(bonds.run_y, bonds.length),
    )
    singles = (bonds.first, bonds.second, bonds.weight, bonds.x, bonds.y)
    return Pairs(*(np.concatenate((r[there], s)) for r, s in zip(runs, singles, strict=True)))
