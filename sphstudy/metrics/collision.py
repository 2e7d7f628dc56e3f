"""What a collision leaves: rebound, bonds torn in it, symmetry."""

from dataclasses import replace

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, body, pure
from sphstudy.numerics.solvers.indicators import cells

TORN = 2.0
"""Length over first length from which on a bond between lattice neighbours counts as broken: rubber at
these speeds stretches by a third, and what has left the kernel's support is no longer held.
"""


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Speed of the left ring's centre of mass after over before, bonds broken, symmetry, momentum."""
    mass, left = run["mass"].values, run["tag_left"].values == 1
    last = run.isel(snapshot=-1)
    speed = config.scene.speed * config.scene.material.wave_speed
    after = np.average(last["velocity_x"].values[left], weights=mass[left])
    stretch = _bond_stretches(run, config)
    momentum = np.hypot(run["history_momentum_x"].values, run["history_momentum_y"].values)
    return {
        "rebound": pure(-float(after) / speed, "speed of a ring after the collision over before"),
        "broken_bonds": pure(
            (stretch > TORN).sum(), f"bonds of lattice neighbours longer than {TORN:g} times"
        ),
        "bonds": pure(stretch.size, "bonds of lattice neighbours, diagonals included"),
        "longest_bond": pure(stretch.max(), "longest of them over its first length"),
        "mirror_defect": pure(
            run["history_mirror_defect"].values.max(), "largest distance from a mirror image, in Δ"
        ),
        "momentum_drift": pure(
            float(momentum.max()) / (float(mass.sum()) * speed),
            "largest total momentum over the sum of the first momenta's sizes",
        ),
    }


def _bond_stretches(run: xr.Dataset, config) -> np.ndarray:
    """Length over first length of every bond along edges and diagonals of lattice cells, at the end."""
    rings = body(run, config)
    # Columns and rows stand at odd multiples of half a spacing.
    sites = np.rint(np.stack((rings.x, rings.y)) / rings.spacing_x - 0.5).astype(np.int64)
    corners = cells(replace(rings, sites=sites, part=rings.tags["left"]))
    ends = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    pairs = np.unique(np.sort(np.concatenate([corners[list(e)] for e in ends], axis=1), axis=0), axis=1)
    last = run.isel(snapshot=-1)
    before, after = (
        np.hypot(x[pairs[1]] - x[pairs[0]], y[pairs[1]] - y[pairs[0]])
        for x, y in ((rings.x, rings.y), (last["x"].values, last["y"].values))
    )
    return after / before
