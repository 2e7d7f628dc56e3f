"""Blocks of pairs: what may be summed at the same time, and in which order.

Sums over unordered pairs write to both particles. Pairs are kept by blocks of consecutive first
particles, so large that no pair reaches farther than into the next block. Then no two even blocks write
to the same particle, nor do two odd ones: all even blocks are summed first, then all odd ones, in
parallel or one after another. Either way each particle receives its terms in the same order, so that the
number of threads changes no bit.
"""

import numpy as np


def begins(first: np.ndarray, size: int, count: int) -> np.ndarray:
    """Where each block of `size` out of `count` particles begins among items ordered by their first
    particle's block; one entry more, the number of items.
    """
    blocks = -(-count // size)
    return np.searchsorted(first // size, np.arange(blocks + 1)).astype(np.int64)
