"""How much of its stress a pulled bar has, at the end of the load and held."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, snapshot
from sphstudy.metrics.stretched import law_of
from sphstudy.model.exact.homogeneous import uniaxial_stress
from sphstudy.model.material import Material


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """σ_xx over the exact stress of the method's law: mean over the middle of the bar at both times, and
    its spread; mean over whole sections, faces included, which is what the bar carries.
    """
    scene = config.scene
    material = Material(scene.E, scene.nu, scene.rho, scene.plane)
    exact = uniaxial_stress(law_of(config), material, scene.strain)
    load, held = (snapshot(run, stage)["stress_xx"].values / exact for stage in ("load", "settle"))
    middle, section = run["tag_middle"].values == 1, run["tag_section"].values == 1
    return shares(load[middle], held[middle], "σ_xx in the middle of the bar") | {
        "stress_share_section": Metric(
            float(held[section].mean()),
            "1",
            "mean σ_xx over the exact stress, when held, faces included, in half of the length",
        )
    }


def shares(load: np.ndarray, held: np.ndarray, what: str) -> dict[str, Metric]:
    """Metrics of stresses over the exact ones, when loaded and when held; arrays of particles."""
    return {
        "stress_share_load": Metric(
            float(load.mean()), "1", f"mean {what} over the exact stress, when loaded"
        ),
        "stress_share": Metric(float(held.mean()), "1", f"mean {what} over the exact stress, when held"),
        "stress_spread": Metric(
            float(held.std()), "1", f"standard deviation of {what} over the exact stress, when held"
        ),
    }
