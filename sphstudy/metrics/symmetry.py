"""How far stresses near the crack tip are from the parity in y of the exact field (thesis 4.4)."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure, snapshot

EVEN = {1: ("xx", "yy"), 2: ("xy",)}
"""Stresses that are equal at y and -y, for each mode; the others change sign."""

RADIUS = 0.125
"""Radius of the disc about the tip and length of the rows ahead of it, in sides of the square: 25 mm."""


class Parts(NamedTuple):
    """Root mean squares of the part of a field that has a parity, and of the rest."""

    right: float
    wrong: float

    @property
    def defect(self) -> float:
        """Wrong part over right part; NaN where there is no right part."""
        return self.wrong / self.right if self.right > 0.0 else np.nan


def parity(field: np.ndarray, even: bool, chosen: np.ndarray) -> Parts:
    """Parts of a field with respect to its parity in y.

    Parameters
    ----------
    field : array [rows, columns]
        Values at the particles of a lattice that is symmetric about y = 0.
    even : bool
        Whether the field should be even, or odd.
    chosen : bool array [rows, columns]
        Particles over which the means are taken.
    """
    same, opposite = 0.5 * (field + field[::-1]), 0.5 * (field - field[::-1])
    right, wrong = (same, opposite) if even else (opposite, same)
    sizes = (float(np.sqrt(np.mean(part[chosen] ** 2))) for part in (right, wrong))
    return Parts(*sizes)


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Parity defects of the three stresses in the settled state, crack length a.

    Mode I: σxx and σyy are even in y and σxy odd; mode II the other way round. Mirror images are pairs
    of particles of the initial lattice. Over a disc about the tip, and over the two rows y = ±Δy/2
    ahead of it.
    """
    state, scene, shape = snapshot(run, "settle"), config.scene, (config.n, config.n)
    x0, y0 = (run[f"reference_{axis}"].values.reshape(shape) for axis in "xy")
    disc = np.hypot(x0, y0) < RADIUS * scene.L
    rows = (run["tag_ahead"].values.reshape(shape) == 1) & (x0 < RADIUS * scene.L)
    metrics: dict[str, Metric] = {}
    for component in ("xx", "yy", "xy"):
        field = state[f"stress_{component}"].values.reshape(shape)
        even = component in EVEN[scene.mode]
        kind = "even" if even else "odd"
        for suffix, chosen, where in (
            ("", disc, "in a disc about the tip"),
            ("_ahead", rows, "in the two rows ahead of the tip"),
        ):
            metrics[f"stress_{component}_parity_defect{suffix}"] = pure(
                parity(field, even, chosen).defect,
                f"part of σ_{component} that is not {kind} in y over the part that is, rms, {where}",
            )
    return metrics
