"""The thesis's method and the total Lagrangian one beside each other: fields of single cells."""

from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.report.drawing import TEXT_WIDTH
from sphstudy.report.figure import figure, figures
from sphstudy.report.figures import bending
from sphstudy.report.figures.crack import COMPONENTS, stress_ahead
from sphstudy.report.figures.side_by_side import METHODS
from sphstudy.report.figures.von_mises import WALL, draw_stress, snapshot_at
from sphstudy.report.series import legend_above, zero_line
from sphstudy.store.record import configuration

_KILOPASCAL = 1e3

_QUARTER = 1.5681
"""A quarter of the plate's period (s), when the thesis shows its stress."""

_ROWS: tuple[tuple[float, str, dict[str, Any], str], ...] = (
    (1.0, "above", {"marker": "^", "color": "C0"}, "-"),
    (-1.0, "below", {"marker": "v", "color": "C1"}, "--"),
)
"""Side of the crack's line, its name, how its particles look, and the style of its exact curve."""


@figure(
    "von Mises stress, side by side",
    "Von Mises stress of the vibrating plate beside the wall, cell (n_y, h̃) = (21, 1.3), t = 1.5681 s, a "
    "quarter of the period, on reference positions, without artificial stress; the same colours in both "
    "panels. The thesis sees unphysical spikes on the lower side (figure 4.3).",
)
def plate_stress(results: Results) -> Figure:
    cell = {"scene": "plate", "h": 1.3, "n": 21}
    drawing = Figure(figsize=(TEXT_WIDTH, 2.4), layout="constrained")
    panels = drawing.subplots(1, 2, sharex=True, sharey=True)
    fields = []
    for axes, (method, name) in zip(panels, METHODS.items(), strict=True):
        run = results.record(cell | {"method": method}, block="plate")
        end = WALL * configuration(run).scene.L
        near = run["reference_x"].values < end
        fields.append(draw_stress(axes, run, _QUARTER, end, near))
        axes.set_title(name)
        axes.set(xlabel="$x_0$ (m)", aspect="equal")
        # The last number of a panel would touch the first of the next.
        axes.locator_params("x", nbins=5, prune="upper")
    panels[0].set_ylabel("$y_0$ (m)")
    for field, _ in fields:
        field.set_clim(0.0, max(highest for _, highest in fields))
    drawing.colorbar(fields[0][0], ax=panels, label="von Mises stress (kPa)", location="top", aspect=50)
    return drawing


@figure(
    "positions long after, side by side",
    "Particles of the bent plate beside the wall, x < 0.3 m, 150 s after the start, h̃ = 1.7, both "
    "methods in explicit steps with the same number of rows, each particle at half its size, with the "
    "smallest distance between two of them (at rest Δy, a little less than Δx). The thesis, n_y = 21: "
    "irregular, clumped in lines at the bottom (figure 4.9).",
)
def bending_positions(results: Results) -> Figure:
    runs = {
        "thesis": results.other("bending_long").record(block="grid"),
        "tl": results.other("tl_bending").record(block="held"),
    }
    states = [
        (f"{METHODS[method]}, $n_y = {configuration(run).n}$", snapshot_at(run, bending.LONG))
        for method, run in runs.items()
    ]
    return bending.beside_wall(states)


@figures(
    mode1_stress=(
        "stress ahead of the tip in mode I, side by side",
        "Mode I: stresses of the two rows of particles ahead of the tip over their original x0, cell "
        "(n_x, h̃) = (60, 1.5) at equilibrium, and Williams' solution at these rows. Hollow: prescribed "
        "particles. The thesis: very good except very close to the tip, and a problem close to x0 = 0.1 "
        "m.",
        1,
    ),
    mode2_stress=(
        "stress ahead of the tip in mode II, side by side",
        "Mode II: stresses of the two rows of particles ahead of the tip over their original x0, cell "
        "(n_x, h̃) = (60, 1.5) at equilibrium, and Williams' solution at these rows. Hollow: prescribed "
        "particles. The thesis: σ_xx and σ_yy should be antisymmetric about the x axis, but are not "
        "close to the tip.",
        2,
    ),
)
def _ahead(results: Results, mode: int) -> Figure:
    """A row of panels for each component of the stress, a column for each method."""
    cell = {"scene": f"mode{mode}", "h": 1.5, "n": 60}
    drawing = Figure(figsize=(TEXT_WIDTH, 7.2), layout="constrained")
    panels = drawing.subplots(len(COMPONENTS), 2, sharex=True, sharey="row")
    for column, (method, name) in zip(panels.T, METHODS.items(), strict=True):
        run = results.record(cell | {"method": method})
        for axes, component in zip(column, COMPONENTS, strict=True):
            _rows_ahead(axes, run, component)
        column[0].set_title(name)
        column[-1].set_xlabel("$x_0$ (m)")
    for axes, component in zip(panels[:, 0], COMPONENTS, strict=True):
        axes.set_ylabel(f"$\\sigma_{{{component}}}$ (kPa)")
    drawing.align_ylabels(panels[:, 0])
    legend_above(drawing, panels[0, 0], columns=2)
    return drawing


def _rows_ahead(axes: Axes, run: xr.Dataset, component: str) -> None:
    """A stress in the row above and the row below the crack's line ahead of the tip, and exactly."""
    stress, x, exact = stress_ahead(run, component, _KILOPASCAL)
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    ahead, frame = run["tag_ahead"].values == 1, run["tag_frame"].values == 1
    for values, (side, name, options, style) in zip(exact, _ROWS, strict=True):
        axes.plot(x, values, style, color="0.2", linewidth=1.2, label=f"exact, row {name}")
        row = ahead & (side * y0 > 0.0)
        look = options | {"linestyle": "none", "markersize": 4}
        axes.plot(x0[row & ~frame], stress[row & ~frame], **look, label=f"SPH, row {name}")
        axes.plot(x0[row & frame], stress[row & frame], **look, markerfacecolor="white")
    zero_line(axes)
