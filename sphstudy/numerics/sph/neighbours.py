"""Half neighbour list, kept as runs: which pairs of particles can interact.

Each unordered pair stands once. Where consecutive particles i, i+1, … have a neighbour at the same
distance in memory (i+d, i+1+d, …), as on any lattice stored row by row, the pairs form a *run*
(start, d, length) over which the pair loops work on contiguous memory. All other pairs are *single*.
A lattice is nearly all runs, a random cloud all singles; both are exact, whatever moves or cracks.
A run may bridge a short gap, such as the end of a lattice row, with pairs beyond reach: they weigh zero
for as long as the list is good.

Pairs are found within the support plus a skin. The list is good for as long as no particle has
moved farther than half the skin, so no pair is ever missed; those in the skin weigh zero. Pairs whose
sight a crack may cut or free while the list is good are *watched*: `look` tests them at every evaluation.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled, compiled_inner
from sphstudy.numerics.sph import pair_blocks
from sphstudy.numerics.sph.crack import HIDDEN, IN_DOUBT, Crack, line_of_sight, outlook, visible

SHORTEST_RUN = 8
"""Shorter runs go to the singles: their set-up costs more than they save."""

LONGEST_GAP = 8
"""A run bridges gaps up to this many pairs: cheaper than starting another one."""

BLOCK = 4096
"""Pairs are ordered by blocks of at least so many particles, so that one block's data stays in cache."""


class Neighbours(NamedTuple):
    """Runs: pairs (start + k, start + offset + k), k < length. Singles: (first, second).

    Of the singles, the first `singles[0]` are in force; `look` appends watched pairs to the lasting ones
    as long as they see each other past the segments watched_low to watched_high of the crack.
    Block b (sph.pair_blocks) holds the runs and lasting singles from run_begin[b], single_begin[b] up to
    the next block's. `total`: pairs in all, without those that only bridge gaps. `skin` (m), and
    `built_x`, `built_y` [N], the positions (m) for which the list was built: how long it is good.
    """

    start: np.ndarray
    offset: np.ndarray
    length: np.ndarray
    first: np.ndarray
    second: np.ndarray
    singles: np.ndarray
    watched_first: np.ndarray
    watched_second: np.ndarray
    watched_low: np.ndarray
    watched_high: np.ndarray
    run_begin: np.ndarray
    single_begin: np.ndarray
    total: int
    skin: float
    built_x: np.ndarray
    built_y: np.ndarray


@compiled_inner
def _cells(x, y, reach):
    """Particles sorted into square cells at least `reach` wide: (columns, rows, begin, order)."""
    count = x.size
    low_x = low_y = np.inf
    high_x = high_y = -np.inf
    for i in range(count):
        if np.isfinite(x[i]) and np.isfinite(y[i]):
            low_x, high_x = min(low_x, x[i]), max(high_x, x[i])
            low_y, high_y = min(low_y, y[i]), max(high_y, y[i])
    # A body that flies apart must not ask for more cells than it has particles to put in them.
    most = 2.0 * np.sqrt(count) + 16.0
    size = max(reach, (high_x - low_x) / most, (high_y - low_y) / most)
    if not np.isfinite(size):
        size, low_x, low_y, high_x, high_y = 1.0, 0.0, 0.0, 0.0, 0.0
    columns = int((high_x - low_x) / size) + 1
    rows = int((high_y - low_y) / size) + 1
    cell = np.zeros(count, np.int64)
    begin = np.zeros(columns * rows + 1, np.int64)
    for i in range(count):
        if np.isfinite(x[i]) and np.isfinite(y[i]):
            cell[i] = int((y[i] - low_y) / size) * columns + int((x[i] - low_x) / size)
        begin[cell[i] + 1] += 1
    for c in range(columns * rows):
        begin[c + 1] += begin[c]
    fill = begin[:-1].copy()
    order = np.empty(count, np.int64)
    for i in range(count):
        order[fill[cell[i]]] = i
        fill[cell[i]] += 1
    return columns, rows, begin, order, cell


@compiled_inner
def _grown(array):
    return np.concatenate((array, np.empty_like(array)))


@compiled
def close_pairs(x, y, reach):
    """All pairs i < j closer than `reach`, ordered by i: two int32 arrays."""
    count = x.size
    columns, rows, begin, order, cell = _cells(x, y, reach)
    first = np.empty(16 * count + 16, np.int32)
    second = np.empty(16 * count + 16, np.int32)
    found = 0
    for i in range(count):
        row, column = divmod(cell[i], columns)
        for r in range(max(row - 1, 0), min(row + 2, rows)):
            for c in range(max(column - 1, 0), min(column + 2, columns)):
                for k in range(begin[r * columns + c], begin[r * columns + c + 1]):
                    j = order[k]
                    if j <= i or not (x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2 < reach * reach:
                        continue
                    if found == first.size:
                        first, second = _grown(first), _grown(second)
                    first[found] = i
                    second[found] = j
                    found += 1
    return first[:found], second[:found]


@compiled
def _judge(first, second, x, y, margin, crack):
    """For all close pairs: whether they last, whether they are to be watched, and past which segments.

    With a crack frozen in its first configuration nothing is in doubt.
    """
    seen_x, seen_y, node_x, node_y, tolerance, frozen = line_of_sight(crack, x, y)
    lasting = np.ones(first.size, np.bool_)
    watched = np.zeros(first.size, np.bool_)
    low, high = np.zeros(first.size, np.int32), np.zeros(first.size, np.int32)
    for p in range(first.size):
        i, j = first[p], second[p]
        ax, ay, bx, by = seen_x[i], seen_y[i], seen_x[j], seen_y[j]
        if frozen:
            lasting[p] = visible(ax, ay, bx, by, node_x, node_y, tolerance)
        else:
            verdict, low[p], high[p] = outlook(ax, ay, bx, by, node_x, node_y, tolerance, margin)
            watched[p] = verdict == IN_DOUBT
            lasting[p] = not watched[p] and verdict != HIDDEN
    return lasting, watched, low, high


def block_size(first: np.ndarray, second: np.ndarray) -> int:
    """Particles of a block: no pair reaches farther than into the next one."""
    return max(BLOCK, 1 + int((second - first).max(initial=0)))


@compiled
def sorted_by_offset(first, second, count, size):
    """The pairs ordered by (block of `size` i, j - i, i): stable counting sort within each block."""
    total = first.size
    ordered_first, ordered_second = np.empty_like(first), np.empty_like(second)
    fill = np.empty(count + 1, np.int64)
    low = 0
    while low < total:
        block = first[low] // size
        high = low
        widest = 0
        while high < total and first[high] // size == block:
            widest = max(widest, second[high] - first[high])
            high += 1
        for d in range(widest + 2):
            fill[d] = 0
        for p in range(low, high):
            fill[second[p] - first[p] + 1] += 1
        for d in range(widest + 1):
            fill[d + 1] += fill[d]
        for p in range(low, high):
            d = second[p] - first[p]
            ordered_first[low + fill[d]] = first[p]
            ordered_second[low + fill[d]] = second[p]
            fill[d] += 1
        low = high
    return ordered_first, ordered_second


@compiled_inner
def _bridges(x, y, reach, first, second, p, size):
    """Whether a run may go on from pair p to pair p + 1: same block and offset, nothing within reach
    skipped.
    """
    offset = second[p] - first[p]
    gap = first[p + 1] - first[p] - 1
    if second[p + 1] - first[p + 1] != offset or not 0 <= gap <= LONGEST_GAP:
        return False
    if first[p + 1] // size != first[p] // size:
        return False
    for i in range(first[p] + 1, first[p + 1]):
        j = i + offset
        if (x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2 < reach * reach:
            return False
    return True


@compiled
def _runs(x, y, reach, first, second, size):
    """Runs of the sorted pairs: start, offset, length, and a mask of the pairs that are in none."""
    total = first.size
    start = np.empty(total // SHORTEST_RUN + 1, np.int64)
    offset = np.empty_like(start)
    length = np.empty_like(start)
    single = np.zeros(total, np.bool_)
    runs = 0
    low = np.int64(0)
    while low < total:
        last = low
        while last + 1 < total and _bridges(x, y, reach, first, second, last, size):
            last += 1
        if last + 1 - low >= SHORTEST_RUN:
            start[runs] = first[low]
            offset[runs] = second[low] - first[low]
            length[runs] = first[last] - first[low] + 1
            runs += 1
        else:
            for p in range(low, last + 1):
                single[p] = True
        low = last + 1
    return start[:runs], offset[:runs], length[:runs], single


def build(x: np.ndarray, y: np.ndarray, support: float, skin: float, crack: Crack | None) -> Neighbours:
    """Neighbours of the configuration x, y [N] (m): every pair closer than `support` + `skin` (m).

    Particles at positions that are not finite get no neighbours. Call `look` before the list is used.
    """
    reach = support + skin
    first, second = close_pairs(x, y, reach)
    none = np.empty(0, np.int32)
    watched_pairs = (none, none, none, none)
    if crack is not None:
        # While the list is good no two particles, nor a particle and a node, approach by more than skin.
        lasting, watched, low, high = _judge(first, second, x, y, skin, crack)
        watched_pairs = (first[watched], second[watched], low[watched], high[watched])
        first, second = first[lasting], second[lasting]
    size = block_size(first, second)
    first, second = sorted_by_offset(first, second, x.size, size)
    start, offset, length, single = _runs(x, y, reach, first, second, size)
    return Neighbours(
        start.copy(),
        offset.copy(),
        length.copy(),
        np.concatenate((first[single], watched_pairs[0])),
        np.concatenate((second[single], watched_pairs[1])),
        np.array([np.count_nonzero(single)]),
        *watched_pairs,
        pair_blocks.begins(start, size, x.size),
        pair_blocks.begins(first[single], size, x.size),
        first.size + watched_pairs[0].size,
        skin,
        x.copy(),
        y.copy(),
    )


@compiled
def look(pairs, x, y, crack):
    """Brings the singles in force up to date with the configuration x, y [N] (m)."""
    if pairs.watched_first.size == 0:
        return
    x, y, node_x, node_y, tolerance, _ = line_of_sight(crack, x, y)
    filled = pairs.first.size - pairs.watched_first.size
    for w in range(pairs.watched_first.size):
        i, j = pairs.watched_first[w], pairs.watched_second[w]
        low, high = pairs.watched_low[w], pairs.watched_high[w] + 1
        if visible(x[i], y[i], x[j], y[j], node_x[low:high], node_y[low:high], tolerance):
            pairs.first[filled] = i
            pairs.second[filled] = j
            filled += 1
    pairs.singles[0] = filled


@compiled
def outdated(pairs, x, y, stride):
    """Whether a particle may get farther than half the skin from where the list was built, moving by up
    to `stride` (m) from x, y [N] (m).
    """
    farthest = 0.0
    for i in range(x.size):
        moved = (x[i] - pairs.built_x[i]) ** 2 + (y[i] - pairs.built_y[i]) ** 2
        farthest = moved if moved > farthest else farthest
    return not np.sqrt(farthest) + stride <= 0.5 * pairs.skin


def as_pairs(pairs: Neighbours) -> tuple[np.ndarray, np.ndarray]:
    """Pairs in force as two arrays of particle indices, runs first, bridging pairs included."""
    along = np.arange(pairs.length.sum()) - np.repeat(
        np.cumsum(pairs.length) - pairs.length, pairs.length
    )
    first = np.repeat(pairs.start, pairs.length) + along
    second = first + np.repeat(pairs.offset, pairs.length)
    singles = pairs.singles[0]
    return (
        np.concatenate((first, pairs.first[:singles])),
        np.concatenate((second, pairs.second[:singles])),
    )
