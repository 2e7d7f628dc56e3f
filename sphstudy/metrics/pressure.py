"""Checkerboards and stripes in the pressure of a plate: what a nearly incompressible solid may show."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure
from sphstudy.metrics.roughness import loaded_state


def checkerboard_share(field: np.ndarray) -> float:
    """Alternating part of a field [rows, columns] over the field, both as root mean squares.

    The alternating part of a cell of four neighbours, a quarter of f00 - f01 - f10 + f11, is of second
    order in the spacing where the field is smooth, and the whole of a field that is ±1 by turns. NaN
    for a field of zeros.
    """
    return _share(0.25 * np.diff(np.diff(field, axis=0), axis=1), field)


def stripe_share(field: np.ndarray) -> float:
    """The same for stripes along the rows: a quarter of two rows' sum less twice the row between."""
    return _share(0.25 * np.diff(field, 2, axis=0), field)


def _share(part: np.ndarray, field: np.ndarray) -> float:
    size = float(np.sqrt(np.mean(field**2)))
    return float(np.sqrt(np.mean(part**2))) / size if size > 0.0 else np.nan


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Shares of both in p = -(σxx + σyy)/2 while the tip is up, at the kept time closest to its highest,
    and at the end of the run; farther than a height from the wall.

    Closer, cells at the corners of the clamp show its singularity, whatever n, as large as the pressure.
    In plane strain the pressure of three dimensions is the same but for a constant factor.
    """
    states = {"": (loaded_state(run), "when the tip is up")}
    if run.sizes["snapshot"]:
        states["_end"] = (run.isel(snapshot=-1), "at the end")
    far = run["reference_x"].values.reshape(config.n, -1)[0] > config.scene.height
    found: dict[str, Metric] = {}
    for suffix, (state, when) in states.items():
        if state is None:
            continue
        pressure = -0.5 * (state["stress_xx"] + state["stress_yy"]).values.reshape(config.n, -1)[:, far]
        for name, share in (("checkerboard", checkerboard_share), ("stripes", stripe_share)):
            found[f"pressure_{name}{suffix}"] = pure(
                share(pressure), f"{name} in the pressure over the pressure, rms, {when}"
            )
    return found
