"""Von Mises stress of the vibrating plate a quarter of a period after its start (thesis 4.1)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from sphstudy.analysis.results import Missing, Results
from sphstudy.report.drawing import footprints, spacing
from sphstudy.report.figure import figures
from sphstudy.report.panels import mises
from sphstudy.store.record import configuration

_KILOPASCAL = 1e3

WALL = 0.2
"""Length of the magnified part beside the wall, in units of L."""


def snapshot_at(run: xr.Dataset, time: float) -> xr.Dataset:
    """The fields of a record at that time (s), to a time step; raises Missing if it has none."""
    distance = np.abs(run["snapshot_time"].values - time)
    if distance.min() > float(run["time_step"]):
        raise Missing(f"{run.attrs['title']}: no snapshot at t = {time:g} s")
    return run.isel(snapshot=int(distance.argmin()))


def draw_stress(
    axes: Axes, run: xr.Dataset, time: float, end: float, drawn: slice | np.ndarray = slice(None)
) -> tuple[PolyCollection, float]:
    """Draws the von Mises stress (kPa) of a plate on reference positions.

    Parameters
    ----------
    axes : Axes
        Where; they show the plate from the wall to `end` (m).
    run : xarray.Dataset
        Record of a plate.
    time : float
        When (s). Missing is raised if the record has no fields then.
    end : float
        Where the axes end (m).
    drawn : slice or array of bool [N]
        Particles that are drawn.

    Returns
    -------
    PolyCollection
        What carries the colours.
    float
        The largest stress drawn (kPa).
    """
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    width, height = spacing(run)
    stress = mises(run, snapshot_at(run, time))[drawn] / _KILOPASCAL
    field = footprints(axes, x0[drawn], y0[drawn], width, height, stress)
    edge = y0.max() + 0.5 * height
    axes.set(xlim=(-0.5 * width, end), ylim=(-edge, edge), yticks=(-edge, 0.0, edge))
    axes.yaxis.set_major_formatter("{x:.3f}")
    axes.grid(False)
    return field, stress.max()


@figures(
    artificial_stress=(
        "4.1",
        "Von Mises stress with artificial stress (ζ = 0.3), cell (n_y, h̃) = (21, 1.5), t = 1.5681 s, a "
        "quarter of the period, on reference positions. Top: whole plate, stretched in y; bottom: "
        "beside the wall, true to scale. The thesis: a disturbance appears at the bottom, where the "
        "plate is attached to the wall.",
        ("artificial", 1.5, 21, 1.5681),
    ),
    fine_narrow=(
        "4.3",
        "Von Mises stress without artificial stress, cell (n_y, h̃) = (21, 1.3), t = 1.5681 s, the "
        "plate close to its highest position, drawn as figure 4.1. The thesis: unphysical spikes on the "
        "lower side beside the wall; the upper side looks a lot better.",
        ("grid", 1.3, 21, 1.5681),
    ),
    fine_medium=(
        "4.4",
        "Von Mises stress without artificial stress, cell (n_y, h̃) = (21, 1.5), t = 1.5681 s, drawn as "
        "figure 4.1. The thesis: a lot more physical than figure 4.3, no spikes.",
        ("grid", 1.5, 21, 1.5681),
    ),
    coarse_narrow=(
        "4.5",
        "Von Mises stress without artificial stress, cell (n_y, h̃) = (9, 1.3), t = 1.5648 s, drawn as "
        "figure 4.1. The thesis: the problem of figure 4.3 does not exist here.",
        ("grid", 1.3, 9, 1.5648),
    ),
)
def _field(results: Results, shown: tuple[str, float, int, float]) -> Figure:
    block, h, n, time = shown
    run = results.record({"h": h, "n": n}, block)
    length = configuration(run).scene.L
    drawing = Figure(figsize=(5.6, 4.3), layout="constrained")
    whole, wall = drawing.subplots(2, 1, height_ratios=(1.0, 2.8))
    for axes, end in ((whole, length), (wall, WALL * length)):
        colours, highest = draw_stress(axes, run, time, end)
        colours.set_clim(0.0, highest)
        axes.set_ylabel("$y_0$ (m)")
    wall.set(xlabel="$x_0$ (m)", aspect="equal")
    drawing.colorbar(colours, ax=(whole, wall), label="von Mises stress (kPa)", location="top", aspect=50)
    return drawing
