"""How much of its stress a disc pulled in all directions has, at the end of the load and held."""

import xarray as xr

from sphstudy.metrics.metric import Metric, snapshot
from sphstudy.metrics.stretched import law_of
from sphstudy.metrics.uniaxial_stress import shares
from sphstudy.model.exact.homogeneous import equibiaxial_stress


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """(σ_xx + σ_yy)/2 over the exact stress of the method's law: mean over the inner half of the disc at
    both times, and its spread.
    """
    exact = equibiaxial_stress(law_of(config), config.scene.material, config.scene.strain)
    middle = run["tag_middle"].values == 1
    states = (snapshot(run, stage) for stage in ("load", "settle"))
    load, held = (0.5 * (s["stress_xx"] + s["stress_yy"]).values[middle] / exact for s in states)
    return shares(load, held, "(σ_xx + σ_yy)/2 in the inner half of the disc")
