"""Particle-to-particle roughness of the von Mises stress near the wall: the spikes of thesis 4.1.

A spike is a particle whose stress differs from that of its two neighbours in the row. High and low by
turns, spikes form the shortest wave that a row of particles carries.
"""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure, snapshot
from sphstudy.metrics.von_mises import von_mises

VISIBLE = 0.05
"""Roughness from which on spikes are seen in a drawing of the field: one in twenty of the colours.

In the thesis's grid of the plate, (15, 1.3) and (21, 1.3) have 0.26 and 0.28 below the axis and all
other cells at most 0.02, as all have at most 0.03 above it: any limit between 0.03 and 0.2 divides alike.
"""

REGION = 0.25
"""The wall's neighbourhood ends at this share of the length."""


def deviation(field: np.ndarray) -> np.ndarray:
    """Difference of each particle's value to the mean of its two neighbours in the row.

    Parameters
    ----------
    field : array [rows, columns]
        Values at the particles of a lattice.

    Returns
    -------
    array [rows, columns - 2]
        For the columns between the first and the last; zero where the field is linear.
    """
    return field[:, 1:-1] - 0.5 * (field[:, :-2] + field[:, 2:])


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Roughness below and above the axis, for x0 beyond the wall's own reach, 2h, and up to L/4.

    Vibrating plate: at the kept time closest to when the tip is highest. Bent plate: when it has
    settled. Root mean square of the deviation over the largest smoothed stress ((1, 2, 1)/4 along the
    row) there. The columns within 2h of the wall are left out: whatever h̃ and n, they show the
    boundary effect of the clamp, alike below and above.
    """
    state = loaded_state(run)
    if state is None:
        return {}
    shape = (config.n, -1)
    xx, yy, xy = (state[f"stress_{c}"].values.reshape(shape) for c in ("xx", "yy", "xy"))
    stress = von_mises(xx, yy, xy, config.scene.plane, config.scene.nu)
    rough = deviation(stress)
    smooth = stress[:, 1:-1] - 0.5 * rough
    x0, y0 = (run[f"reference_{axis}"].values.reshape(shape)[:, 1:-1] for axis in "xy")
    reach = config.h * (float(run["spacing_x"]) + float(run["spacing_y"]))
    wall = (x0 > reach) & (x0 < REGION * config.scene.L)
    if not wall.any() or (largest := float(smooth[wall].max())) <= 0.0:
        return {}
    return {
        f"stress_roughness_{side}": pure(
            float(np.sqrt(np.mean(rough[wall & chosen] ** 2))) / largest,
            f"particle-to-particle roughness of the von Mises stress near the wall, {where} the axis",
        )
        for side, where, chosen in (("bottom", "below", y0 < 0.0), ("top", "above", y0 > 0.0))
    }


def loaded_state(run: xr.Dataset) -> xr.Dataset | None:
    """The state in which a plate is bent.

    Parameters
    ----------
    run : xarray.Dataset
        The record of a plate.

    Returns
    -------
    xarray.Dataset or None
        The settled state; without one, of the kept times at which the tip is up, the one closest to its
        highest point; None where there is neither.
    """
    labels = [str(label) for label in run["snapshot_label"].values]
    if "settle" in labels:
        return snapshot(run, "settle")
    times = run["snapshot_time"].values
    if not run.sizes.get("sample"):
        return None
    history, u_y = run["history_time"].values, run["history_u_y"].values
    highest = float(u_y.max())
    up = [
        k
        for k, label in enumerate(labels)
        if label.startswith("t=") and np.interp(times[k], history, u_y) > 0.5 * highest > 0.0
    ]
    if not up:
        return None
    peak = history[int(np.argmax(u_y))]
    return run.isel(snapshot=min(up, key=lambda k: abs(times[k] - peak)))
