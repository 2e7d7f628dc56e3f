"""How well the inside of a patch follows the affine displacement of its frame."""

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from sphstudy.metrics.metric import Metric, pure, snapshot

REACH = 2.3
"""Radius of the fit, in spacings: twenty neighbours on a lattice."""


def displacement_gradients(place: np.ndarray, moved: np.ndarray, reach: float) -> np.ndarray:
    """Displacement gradients by least squares over neighbours, with weight 1 - (r/reach)².

    Parameters
    ----------
    place, moved : array [2, N]
        Reference positions and displacements (m).
    reach : float
        Distance within which particles are neighbours (m).

    Returns
    -------
    array [2, 2, N]
        ∂u_a/∂x_b of each particle; exact where displacements are affine.

    Raises
    ------
    numpy.linalg.LinAlgError
        Where neighbours lie in a line.
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
    state, exact = snapshot(run, "settle"), config.scene.gradient
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
        found[name] = pure(error.max(), f"largest error of the {what}")
        found[f"{name}_rms"] = pure(np.sqrt(np.mean(error**2)), f"root mean square error of the {what}")
    return found
