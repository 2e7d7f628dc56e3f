"""How much of its stress a pulled bar has, at the end of the load and held."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure, snapshot
from sphstudy.metrics.stretched import law_of
from sphstudy.model.exact.homogeneous import uniaxial_stress


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """σ_xx over the exact stress of the method's law: mean over the middle of the bar at both times, and
    its spread; mean over whole sections, faces included, which is what the bar carries.
    """
    scene = config.scene
    exact = uniaxial_stress(law_of(config), scene.material, scene.strain)
    load, held = (snapshot(run, stage)["stress_xx"].values / exact for stage in ("load", "settle"))
    middle, section = run["tag_middle"].values == 1, run["tag_section"].values == 1
    return shares(load[middle], held[middle], "σ_xx in the middle of the bar") | {
        "stress_share_section": pure(
            held[section].mean(),
            "mean σ_xx over the exact stress, when held, faces included, in half of the length",
        )
    }


def shares(load: np.ndarray, held: np.ndarray, what: str) -> dict[str, Metric]:
    """Metrics of a stress over the exact one.

    Parameters
    ----------
    load, held : array [M]
        Stress over the exact stress, of particles, when loaded and when held.
    what : str
        Name of the stress and of the place, for the metrics' descriptions.
    """
    return {
        "stress_share_load": pure(load.mean(), f"mean {what} over the exact stress, when loaded"),
        "stress_share": pure(held.mean(), f"mean {what} over the exact stress, when held"),
        "stress_spread": pure(
            held.std(), f"standard deviation of {what} over the exact stress, when held"
        ),
    }
