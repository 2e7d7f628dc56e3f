"""Whether a body in a homogeneous state still lies on its (stretched) lattice, has clumped or come apart.

Distances are compared with those of the exact state, so that 1 is right whatever the strain.
"""

import numpy as np
import xarray as xr
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from sphstudy.metrics.metric import Metric, pure, snapshot
from sphstudy.metrics.regularity import nearest_distances
from sphstudy.model.exact.homogeneous import lateral_stretch

NEIGHBOURS = 1.2
"""Distance in the reference configuration, in spacings, below which particles are neighbours on the
lattice: between one and √2, with room for the noise."""

OPEN = 1.5
"""Distance over that in the exact state up to which lattice neighbours hold together."""


def lattice_pairs(x: np.ndarray, y: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of lattice neighbours.

    Parameters
    ----------
    x, y : array [N]
        Reference positions (m).
    spacing : float
        Spacing of the lattice (m).

    Returns
    -------
    pairs : int array [2, P]
        Indices of the particles.
    along : bool array [P]
        Which pairs lie along x.
    """
    place = np.column_stack((x, y))
    pairs = cKDTree(place).query_pairs(NEIGHBOURS * spacing, output_type="ndarray").T
    apart = np.abs(place[pairs[1]] - place[pairs[0]])
    return pairs, apart[:, 0] > apart[:, 1]


def pieces(pairs: np.ndarray, particles: int) -> int:
    """Number of parts into which particles fall when only these pairs [2, P] hold together."""
    bonds = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(particles, particles))
    return int(connected_components(bonds, directed=False, return_labels=False))


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Metrics of the held state: distances to the nearest neighbour, of free particles; gaps between
    lattice neighbours, and whether open ones cut the body apart.
    """
    state, spacing = snapshot(run, "settle"), float(run["spacing_x"])
    along, across = _stretches(config)
    x, y = state["x"].values, state["y"].values
    nearest = nearest_distances(x, y)[run["tag_driven"].values == 0] / (spacing * min(along, across))
    pairs, in_x = lattice_pairs(run["reference_x"].values, run["reference_y"].values, spacing)
    apart = np.hypot(x[pairs[1]] - x[pairs[0]], y[pairs[1]] - y[pairs[0]]) / spacing
    gap = apart / np.where(in_x, along, across)
    return {
        "spacing_smallest": pure(
            nearest.min(), "smallest distance to a neighbour over that of the exact state"
        ),
        "spacing_spread": pure(
            nearest.std() / nearest.mean(),
            "standard deviation over mean of distances to the nearest neighbour",
        ),
        "gap_largest": pure(
            gap.max(), "largest distance between lattice neighbours over that of the exact state"
        ),
        "gaps_open": pure(
            np.mean(gap > OPEN), f"share of lattice neighbours for which that is over {OPEN:g}"
        ),
        "torn": pure(
            pieces(pairs[:, gap <= OPEN], x.size) > 1,
            "1 if the body is in pieces when only the other lattice neighbours hold together",
        ),
    }


def _stretches(config) -> tuple[float, float]:
    """Stretches of the exact state along x and y."""
    scene, along = config.scene, 1.0 + config.scene.strain
    if scene.kind == "radial":
        return along, along
    return along, lateral_stretch(law_of(config), scene.material, scene.strain)


def law_of(config) -> str:
    """Name of the law in sphstudy.model.exact.homogeneous that a method follows."""
    return getattr(config.method, "law", "rate")
