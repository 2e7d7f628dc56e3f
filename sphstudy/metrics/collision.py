"""What a collision leaves: rebound, bonds torn in it, symmetry."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric
from sphstudy.model.scenes.rings import rings_body
from sphstudy.numerics.solvers.indicators import cells

TORN = 2.0
"""Times its first length, from which on a bond between lattice neighbours counts as broken: rubber at
these speeds stretches by a third, and what has left the kernel's support is no longer held.
"""


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Speed of the left ring's centre of mass after over before, bonds broken, symmetry, momentum."""
    mass, left = run["mass"].values, run["tag_left"].values == 1
    last = run.isel(snapshot=-1)
    speed = config.scene.speed * rings_body(config).material.wave_speed
    after = np.average(last["velocity_x"].values[left], weights=mass[left])
    stretch = bond_stretches(run, config)
    momentum = np.hypot(run["history_momentum_x"].values, run["history_momentum_y"].values)
    return {
        "rebound": Metric(-float(after) / speed, "1", "speed of a ring after the collision over before"),
        "broken_bonds": Metric(
            float((stretch > TORN).sum()), "1", f"bonds of lattice neighbours longer than {TORN:g} times"
        ),
        "bonds": Metric(float(stretch.size), "1", "bonds of lattice neighbours, diagonals included"),
        "longest_bond": Metric(float(stretch.max()), "1", "longest of them over its first length"),
        "mirror_defect": Metric(
            float(run["history_mirror_defect"].max()), "1", "largest distance from a mirror image, in Δ"
        ),
        "momentum_drift": Metric(
            float(momentum.max()) / (float(mass.sum()) * speed),
            "1",
            "largest total momentum over the sum of the first momenta's sizes",
        ),
    }


def bond_stretches(run: xr.Dataset, config) -> np.ndarray:
    """Length over first length of every bond along edges and diagonals of lattice cells, at the end."""
    corners = cells(rings_body(config))
    ends = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    pairs = np.unique(np.sort(np.concatenate([corners[list(e)] for e in ends], axis=1), axis=0), axis=1)
    last = run.isel(snapshot=-1)
    lengths = [
        np.hypot(x[pairs[1]] - x[pairs[0]], y[pairs[1]] - y[pairs[0]])
        for x, y in (
            (run["reference_x"].values, run["reference_y"].values),
            (last["x"].values, last["y"].values),
        )
    ]
    return lengths[1] / lengths[0]
