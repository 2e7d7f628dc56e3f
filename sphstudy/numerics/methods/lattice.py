"""What methods on lattices have in common: the reach of the kernel, and whether h and n fit it."""

import math
from collections.abc import Iterator
from functools import cache

import numpy as np

from sphstudy.numerics.sph import kernel

FEWEST_NEIGHBOURS = 8
"""On a square lattice, inside the support: fewer leave the velocity gradient without its diagonals."""


def support(config) -> float:
    """Radius of the kernel's support, in particle spacings."""
    return config.h * kernel.KERNELS[config.method.kernel].support


def lattice_neighbours(config) -> int:
    """Neighbours of a particle of a square lattice that lie strictly inside its support."""
    return _inside(support(config))


@cache
def _inside(radius: float) -> int:
    reach = np.arange(-math.ceil(radius), math.ceil(radius) + 1)
    distance_squared = reach[:, None] ** 2 + reach[None, :] ** 2
    return int(np.count_nonzero(distance_squared < radius**2 * (1.0 - 1e-12))) - 1


def check(config) -> Iterator[str]:
    """Complaints about h and n."""
    if support(config) >= config.n:
        yield f"h={config.h:g}: the support is wider than the body's {config.n} rows"
        return
    found = lattice_neighbours(config)
    if found < FEWEST_NEIGHBOURS:
        least = math.sqrt(2) * config.h / support(config)
        yield (
            f"h={config.h:g}: too few neighbours for this method ({found}, at least "
            f"{FEWEST_NEIGHBOURS} needed: h > {least:.4g})"
        )
