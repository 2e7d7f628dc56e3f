"""Whether a body in a homogeneous state still lies on its (stretched) lattice, has clumped or come apart.

Distances are compared with those of the exact state, so that 1 is right whatever the strain.
"""

import numpy as np
import xarray as xr
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from sphstudy.metrics.metric import Metric, snapshot
from sphstudy.metrics.regularity import nearest_distances
from sphstudy.model.exact.homogeneous import lateral_stretch
from sphstudy.model.material import Material

NEIGHBOURS = 1.2
"""Particles nearer than so many spacings in the reference configuration are neighbours on the lattice:
between one and √2, with room for the noise."""

OPEN = 1.5
"""Lattice neighbours hold together until they are so many times farther apart than in the exact state."""


def lattice_pairs(x: np.ndarray, y: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of lattice neighbours [2, P] at x, y [N] (m), and which of them [P] lie along x."""
    place = np.column_stack((x, y))
    pairs = cKDTree(place).query_pairs(NEIGHBOURS * spacing, output_type="ndarray").T
    apart = np.abs(place[pairs[1]] - place[pairs[0]])
    return pairs, apart[:, 0] > apart[:, 1]


def pieces(pairs: np.ndarray, particles: int) -> int:
    """How many parts N particles fall into when only these pairs [2, P] hold together."""
    bonds = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(particles, particles))
    return int(connected_components(bonds, directed=False, return_labels=False))


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Smallest nearest-neighbour distance and its spread over free particles, largest gap, share of open
    gaps, torn or not: whether open gaps cut the body apart. All of the held state.
    """
    state, spacing = snapshot(run, "settle"), float(run["spacing_x"])
    along, across = _stretches(config)
    x, y = state["x"].values, state["y"].values
    nearest = nearest_distances(x, y)[run["tag_driven"].values == 0] / (spacing * min(along, across))
    pairs, in_x = lattice_pairs(run["reference_x"].values, run["reference_y"].values, spacing)
    apart = np.hypot(x[pairs[1]] - x[pairs[0]], y[pairs[1]] - y[pairs[0]]) / spacing
    gap = apart / np.where(in_x, along, across)
    return {
        "spacing_smallest": Metric(
            float(nearest.min()), "1", "smallest distance to a neighbour over that of the exact state"
        ),
        "spacing_spread": Metric(
            float(nearest.std() / nearest.mean()),
            "1",
            "standard deviation over mean of distances to the nearest neighbour",
        ),
        "gap_largest": Metric(
            float(gap.max()),
            "1",
            "largest distance between lattice neighbours over that of the exact state",
        ),
        "gaps_open": Metric(
            float(np.mean(gap > OPEN)),
            "1",
            f"share of lattice neighbours for which that is over {OPEN:g}",
        ),
        "torn": Metric(
            float(pieces(pairs[:, gap <= OPEN], x.size) > 1),
            "1",
            "1 if the body is in pieces when only the other lattice neighbours hold together",
        ),
    }


def _stretches(config) -> tuple[float, float]:
    """Stretches of the exact state along x and y."""
    scene, along = config.scene, 1.0 + config.scene.strain
    if scene.kind == "radial":
        return along, along
    material = Material(scene.E, scene.nu, scene.rho, scene.plane)
    return along, lateral_stretch(law_of(config), material, scene.strain)


def law_of(config) -> str:
    """Name of the law in sphstudy.model.exact.homogeneous that a method follows."""
    return getattr(config.method, "law", "rate")
