"""Momentum and energy balance, smallest spacing: whether a run kept what it should."""

import numpy as np
import xarray as xr
from scipy.integrate import cumulative_trapezoid

from sphstudy.metrics.metric import Metric


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Energy put in and not found again, unbalanced internal force, smallest spacing."""
    history = {name: run[f"history_{name}"].values for name in _COLUMNS}
    energy = history["kinetic_energy"] + history["strain_energy"]
    work = cumulative_trapezoid(history["constraint_power"], history["time"], initial=0.0)
    put_in = energy[0] + work
    scale = float(np.max(np.abs(put_in)))
    spacing = min(float(run["spacing_x"]), float(run["spacing_y"]))
    return {
        "dissipated_energy": Metric(
            float(put_in[-1] - energy[-1]) / scale,
            "1",
            "share of initial energy and work of the constraints not found as kinetic or strain energy",
        ),
        "external_work": Metric(float(work[-1]), "J m-1", "work of the constraints"),
        "net_internal_force": Metric(
            float(history["net_internal_force"].max()),
            "1",
            "largest |sum of internal forces| over the sum of their magnitudes",
        ),
        "smallest_spacing": Metric(
            float(history["smallest_spacing"].min()) / spacing,
            "1",
            "smallest distance between particles that see each other, in initial spacings",
        ),
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
