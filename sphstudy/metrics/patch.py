"""How well the inside of a patch follows the affine displacement of its frame."""

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from sphstudy.metrics.metric import Metric, snapshot
from sphstudy.model.scenes.patch import affine

REACH = 2.3
"""Radius of the fit, in spacings: twenty neighbours on a lattice."""


def displacement_gradients(place: np.ndarray, moved: np.ndarray, reach: float) -> np.ndarray:
    """∂u_a/∂x_b [2, 2, N]: least squares over neighbours nearer than `reach` (m), weight 1 - (r/reach)².

    place, moved [2, N]: reference positions and displacements (m). Exact for affine displacements. Raises
    numpy.linalg.LinAlgError where neighbours lie in a line.
    """
    pairs = cKDTree(place.T).query_pairs(reach, output_type="ndarray")
    i, j = np.concatenate((pairs, pairs[:, ::-1])).T
    apart, change = place[:, j] - place[:, i], moved[:, j] - moved[:, i]
    weight = 1.0 - (apart**2).sum(axis=0) / reach**2
    moments, changes = np.zeros((2, place.shape[1], 2, 2))
    np.add.at(moments, i, np.einsum("p,ap,bp->pab", weight, apart, apart))
    np.add.at(changes, i, np.einsum("p,ap,bp->pab", weight, change, apart))
    return np.moveaxis(changes @ np.linalg.inv(moments), 0, -1)


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Errors of displacement and of its gradient over the free particles, largest and root mean square.

    Over the largest prescribed displacement, and over the magnitude of the prescribed gradient.
    """
    state, exact = snapshot(run, "settle"), affine(config.scene)
    place = np.stack((run["reference_x"].values, run["reference_y"].values))
    moved = np.stack((state["x"].values, state["y"].values)) - place
    free = run["tag_frame"].values == 0
    off = np.hypot(*(moved - exact @ place)) / np.hypot(*(exact @ place)).max()
    gradients = displacement_gradients(place, moved, REACH * float(run["spacing_x"]))
    strain = np.sqrt(((gradients - exact[..., None]) ** 2).sum(axis=(0, 1)) / (exact**2).sum())
    found = {}
    for name, error, what in (
        ("displacement_error", off[free], "displacement over the largest prescribed one"),
        ("strain_error", strain[free], "displacement gradient over the prescribed one"),
    ):
        found[name] = Metric(float(error.max()), "1", f"largest error of the {what}")
        found[f"{name}_rms"] = Metric(
            float(np.sqrt(np.mean(error**2))), "1", f"root mean square error of the {what}"
        )
    return found
