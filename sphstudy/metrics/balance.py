"""Momentum and energy balance, smallest spacing: whether a run kept what it should."""

import numpy as np
import xarray as xr
from scipy.integrate import cumulative_trapezoid

from sphstudy.metrics.metric import Metric, pure


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Unbalanced internal force and smallest spacing; of a run that knew time, the lost energy too."""
    if not run.sizes.get("sample"):
        return {}
    history = {name: run[f"history_{name}"].values for name in _COLUMNS}
    spacing = min(float(run["spacing_x"]), float(run["spacing_y"]))
    found = {
        "net_internal_force": pure(
            history["net_internal_force"].max(),
            "largest |sum of internal forces| over the sum of their magnitudes",
        ),
        "smallest_spacing": pure(
            float(history["smallest_spacing"].min()) / spacing,
            "smallest distance between particles that see each other, in initial spacings",
        ),
    }
    if float(run["time_step"]) == 0.0:
        return found
    work = cumulative_trapezoid(history["constraint_power"], history["time"], initial=0.0)
    energy = history["kinetic_energy"] + history["strain_energy"]
    put_in = energy[0] + work
    # Where no energy was ever put in, none can be missing: the energies are then no share of anything.
    scale = float(np.max(np.abs(put_in))) or float(np.max(np.abs(energy))) or 1.0
    return found | {
        "dissipated_energy": pure(
            float(put_in[-1] - energy[-1]) / scale,
            "share of initial energy and work of the constraints not found as kinetic or strain energy",
        ),
        "energy_drift": pure(
            float(np.max(np.abs(put_in - energy))) / scale,
            "largest difference of energy put in and energy found, over the most put in",
        ),
        "external_work": Metric(float(work[-1]), "J m-1", "work of the constraints"),
        "largest_speed": Metric(
            float(history["largest_speed"].max()), "m s-1", "largest speed of a particle"
        ),
    }


_COLUMNS = (
    "time",
    "kinetic_energy",
    "strain_energy",
    "constraint_power",
    "net_internal_force",
    "smallest_spacing",
    "largest_speed",
)
