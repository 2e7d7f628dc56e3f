"""Checkerboard in the pressure of a plate: what a nearly incompressible solid shows of a bad pairing."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric
from sphstudy.metrics.roughness import loaded_state


def checkerboard_share(field: np.ndarray) -> float:
    """Alternating part of a field [rows, columns] over the field, root mean squares both.

    The alternating part of a cell of four neighbours, a quarter of f00 - f01 - f10 + f11, is of second
    order in the spacing where the field is smooth, and all there is of a field ±1 by turns. NaN for a
    field of zeros.
    """
    cells = 0.25 * (field[:-1, :-1] - field[:-1, 1:] - field[1:, :-1] + field[1:, 1:])
    size = float(np.sqrt(np.mean(field**2)))
    return float(np.sqrt(np.mean(cells**2))) / size if size > 0.0 else np.nan


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Share of the checkerboard in p = -(σxx + σyy)/2 while the tip is up, at the kept time closest to its
    highest, and at the end of the run.

    In plane strain the pressure of three dimensions is the same but for a constant factor.
    """
    up = loaded_state(run)
    states = {"": (up, "when the tip is up")}
    if run.sizes["snapshot"]:
        states["_end"] = (run.isel(snapshot=-1), "at the end")
    found: dict[str, Metric] = {}
    for suffix, (state, when) in states.items():
        if state is None:
            continue
        pressure = -0.5 * (state["stress_xx"] + state["stress_yy"]).values
        found[f"pressure_checkerboard{suffix}"] = Metric(
            checkerboard_share(pressure.reshape(config.n, -1)),
            "1",
            f"checkerboard in the pressure over the pressure, rms, {when}",
        )
    return found
