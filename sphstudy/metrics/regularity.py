"""How regularly particles lie: distances to the nearest neighbour, in parts of the plate (thesis 4.2)."""

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from sphstudy.metrics.metric import Metric, pure

IRREGULAR_REGION = 0.3
"""The thesis finds clumped particles up to this share of the length (0 < x < 0.3 m), figure 4.9."""

EARLY = 11.0
"""Time (s) at which the thesis shows regular particles, figure 4.8."""


def nearest_distances(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Distance of each particle to its nearest neighbour.

    Parameters
    ----------
    x, y : array [N]
        Positions (m) of at least two particles.

    Returns
    -------
    array [N]
        Distances (m).
    """
    return cKDTree(np.column_stack((x, y))).query(np.column_stack((x, y)), k=2)[0][:, 1]


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Smallest nearest-neighbour distance and its relative spread, in three parts of the plate, at the
    end.

    Parts: below and above the axis for 0 < x0 < 0.3 L, and all beyond. Names with `_11s`: the same at
    the kept time of 11 s, if the run has it.
    """
    last = run.sizes["snapshot"] - 1
    moments = {"": last} if last >= 0 else {}
    for k, label in enumerate(run["snapshot_label"].values):
        # A kept time is that of a step, so it is close to the time asked for.
        if str(label).startswith("t=") and abs(float(run["snapshot_time"][k]) - EARLY) < 0.01:
            moments[f"_{EARLY:g}s"] = k
    spacing = min(float(run["spacing_x"]), float(run["spacing_y"]))
    metrics: dict[str, Metric] = {}
    for suffix, k in moments.items():
        state = run.isel(snapshot=k)
        distance = nearest_distances(state["x"].values, state["y"].values) / spacing
        when = f"at {EARLY:g} s" if suffix else "at the end"
        for part, (where, chosen) in _parts(run, config.scene.L).items():
            there = distance[chosen]
            if there.size == 0:
                continue
            metrics[f"spacing_smallest_{part}{suffix}"] = pure(
                there.min(), f"smallest distance to a neighbour over Δ, {where}, {when}"
            )
            metrics[f"spacing_spread_{part}{suffix}"] = pure(
                there.std() / there.mean(),
                f"standard deviation over mean of distances to the nearest neighbour, {where}, {when}",
            )
    return metrics


def _parts(run: xr.Dataset, length: float) -> dict[str, tuple[str, np.ndarray]]:
    """For each part of the plate, in words and as a mask of particles."""
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    beyond = x0 >= IRREGULAR_REGION * length
    near = (x0 > 0.0) & ~beyond
    return {
        "bottom": ("below the axis near the wall", near & (y0 < 0.0)),
        "top": ("above the axis near the wall", near & (y0 > 0.0)),
        "rest": ("away from the wall", beyond),
    }
