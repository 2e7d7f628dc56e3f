"""Von Mises stress of the vibrating plate a quarter of a period after its start (thesis 4.1)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from sphstudy.analysis.results import Missing, Results
from sphstudy.metrics.von_mises import von_mises
from sphstudy.report.drawing import footprints
from sphstudy.report.figure import figure
from sphstudy.store.record import configuration

_KILOPASCAL = 1e3

_WALL = 0.2
"""Length of the magnified part beside the wall, in units of L."""


@figure(
    "4.1",
    "Von Mises stress with artificial stress (ζ = 0.3), cell (n_y, h̃) = (21, 1.5), t = 1.5681 s, a "
    "quarter of the period, on reference positions. Top: whole plate, stretched in y; bottom: beside "
    "the wall, true to scale. The thesis: a disturbance appears at the bottom, where the plate is "
    "attached to the wall.",
)
def artificial_stress(results: Results) -> Figure:
    return _field(results.record({"h": 1.5, "n": 21}, block="artificial"), 1.5681)


@figure(
    "4.3",
    "Von Mises stress without artificial stress, cell (n_y, h̃) = (21, 1.3), t = 1.5681 s, the plate "
    "close to its highest position, drawn as figure 4.1. The thesis: unphysical spikes on the lower "
    "side beside the wall; the upper side looks a lot better.",
)
def fine_narrow(results: Results) -> Figure:
    return _field(results.record({"h": 1.3, "n": 21}, block="grid"), 1.5681)


@figure(
    "4.4",
    "Von Mises stress without artificial stress, cell (n_y, h̃) = (21, 1.5), t = 1.5681 s, drawn as "
    "figure 4.1. The thesis: a lot more physical than figure 4.3, no spikes.",
)
def fine_medium(results: Results) -> Figure:
    return _field(results.record({"h": 1.5, "n": 21}, block="grid"), 1.5681)


@figure(
    "4.5",
    "Von Mises stress without artificial stress, cell (n_y, h̃) = (9, 1.3), t = 1.5648 s, drawn as "
    "figure 4.1. The thesis: the problem of figure 4.3 does not exist here.",
)
def coarse_narrow(results: Results) -> Figure:
    return _field(results.record({"h": 1.3, "n": 9}, block="grid"), 1.5648)


def snapshot_at(run: xr.Dataset, time: float) -> xr.Dataset:
    """The fields of a record within a time step of that time (s). Raises Missing if there are none."""
    distance = np.abs(run["snapshot_time"].values - time)
    if distance.min() > float(run["time_step"]):
        raise Missing(f"{run.attrs['title']}: no snapshot at t = {time:g} s")
    return run.isel(snapshot=int(distance.argmin()))


def _field(run: xr.Dataset, time: float) -> Figure:
    state, scene = snapshot_at(run, time), configuration(run).scene
    xx, yy, xy = (state[f"stress_{c}"].values for c in ("xx", "yy", "xy"))
    stress = von_mises(xx, yy, xy, scene.plane, scene.nu) / _KILOPASCAL
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    spacing = float(run["spacing_x"]), float(run["spacing_y"])

    drawing = Figure(figsize=(5.6, 4.3), layout="constrained")
    whole, wall = drawing.subplots(2, 1, height_ratios=(1.0, 2.8))
    for axes, end in ((whole, scene.L), (wall, _WALL * scene.L)):
        colours = footprints(axes, x0, y0, *spacing, stress, clim=(0.0, stress.max()))
        edge = y0.max() + 0.5 * spacing[1]
        axes.set(xlim=(-0.5 * spacing[0], end), ylim=(-edge, edge), yticks=(-edge, 0.0, edge))
        axes.set_ylabel("$y_0$ (m)")
        axes.yaxis.set_major_formatter("{x:.3f}")
        axes.grid(False)
    wall.set(xlabel="$x_0$ (m)", aspect="equal")
    drawing.colorbar(colours, ax=(whole, wall), label="von Mises stress (kPa)", location="top", aspect=50)
    return drawing
