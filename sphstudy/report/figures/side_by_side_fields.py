"""The thesis's method and the total Lagrangian one beside each other: fields of single cells."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.metrics.metric import snapshot
from sphstudy.metrics.von_mises import von_mises
from sphstudy.model.exact import williams
from sphstudy.report.drawing import TEXT_WIDTH, beside_wall, footprints
from sphstudy.report.figure import figure
from sphstudy.report.figures.side_by_side import METHODS
from sphstudy.report.figures.von_mises import snapshot_at
from sphstudy.report.series import legend_above
from sphstudy.store.record import configuration

_KILOPASCAL = 1e3

_QUARTER = 1.5681
"""A quarter of the plate's period (s), when the thesis shows its stress."""

_WALL = 0.2
"""Length of the part beside the wall whose stress is shown, in units of L."""

LONG = 150.0
"""Time (s) after which the thesis looks again at the bent plate."""

NEAR = 0.3
"""Length of the part beside the wall where it does so, in units of L."""

_COMPONENTS = ("xx", "yy", "xy")

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
        fields.append(_near_wall(axes, run))
        axes.set_title(name)
        axes.set(xlabel="$x_0$ (m)", aspect="equal")
        # The last number of a panel would touch the first of the next.
        axes.locator_params("x", nbins=5, prune="upper")
    panels[0].set_ylabel("$y_0$ (m)")
    highest = max(field.get_array().max() for field in fields)
    for field in fields:
        field.set_clim(0.0, highest)
    drawing.colorbar(fields[0], ax=panels, label="von Mises stress (kPa)", location="top", aspect=50)
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
        (f"{METHODS[method]}, $n_y = {configuration(run).n}$", snapshot_at(run, LONG))
        for method, run in runs.items()
    ]
    return beside_wall(states, NEAR * configuration(runs["tl"]).scene.L)


@figure(
    "stress ahead of the tip in mode I, side by side",
    "Mode I: stresses of the two rows of particles ahead of the tip over their original x0, cell (n_x, "
    "h̃) = (60, 1.5) at equilibrium, and Williams' solution at these rows. Hollow: prescribed particles. "
    "The thesis: very good except very close to the tip, and a problem close to x0 = 0.1 m.",
)
def mode1_stress(results: Results) -> Figure:
    return _ahead(results, 1)


@figure(
    "stress ahead of the tip in mode II, side by side",
    "Mode II: stresses of the two rows of particles ahead of the tip over their original x0, cell (n_x, "
    "h̃) = (60, 1.5) at equilibrium, and Williams' solution at these rows. Hollow: prescribed particles. "
    "The thesis: σ_xx and σ_yy should be antisymmetric about the x axis, but are not close to the tip.",
)
def mode2_stress(results: Results) -> Figure:
    return _ahead(results, 2)


def _near_wall(axes: Axes, run: xr.Dataset):
    """Von Mises stress (kPa) of the particles beside the wall; returns what carries the colours."""
    state, scene = snapshot_at(run, _QUARTER), configuration(run).scene
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    spacing = float(run["spacing_x"]), float(run["spacing_y"])
    near = x0 < _WALL * scene.L
    xx, yy, xy = (state[f"stress_{c}"].values[near] for c in _COMPONENTS)
    stress = von_mises(xx, yy, xy, scene.plane, scene.nu) / _KILOPASCAL
    field = footprints(axes, x0[near], y0[near], *spacing, stress)
    edge = y0.max() + 0.5 * spacing[1]
    axes.set(xlim=(-0.5 * spacing[0], _WALL * scene.L), ylim=(-edge, edge), yticks=(-edge, 0.0, edge))
    axes.yaxis.set_major_formatter("{x:.3f}")
    axes.grid(False)
    return field


def _ahead(results: Results, mode: int) -> Figure:
    """A row of panels for each component of the stress, a column for each method."""
    cell = {"scene": f"mode{mode}", "h": 1.5, "n": 60}
    drawing = Figure(figsize=(TEXT_WIDTH, 7.2), layout="constrained")
    panels = drawing.subplots(len(_COMPONENTS), 2, sharex=True, sharey="row")
    for column, (method, name) in zip(panels.T, METHODS.items(), strict=True):
        run = results.record(cell | {"method": method})
        for axes, component in zip(column, _COMPONENTS, strict=True):
            _rows_ahead(axes, run, component)
        column[0].set_title(name)
        column[-1].set_xlabel("$x_0$ (m)")
    for axes, component in zip(panels[:, 0], _COMPONENTS, strict=True):
        axes.set_ylabel(f"$\\sigma_{{{component}}}$ (kPa)")
    drawing.align_ylabels(panels[:, 0])
    legend_above(drawing, panels[0, 0], columns=2)
    return drawing


def _rows_ahead(axes: Axes, run: xr.Dataset, component: str) -> None:
    """A stress in the row above and the row below the crack's line ahead of the tip, and exactly."""
    scene, state = configuration(run).scene, snapshot(run, "settle")
    stress = state[f"stress_{component}"].values / _KILOPASCAL
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    ahead, frame = run["tag_ahead"].values == 1, run["tag_frame"].values == 1
    half = 0.5 * float(run["spacing_y"])
    # From the first particle on: in between, the exact solution has nothing to be compared with.
    x = half + (0.5 * scene.L - half) * np.linspace(0.0, 1.0, 400) ** 2
    for side, name, options, style in _ROWS:
        exact = williams.stress(scene.mode, x, np.full_like(x, side * half), scene.K)
        values = exact[_COMPONENTS.index(component)] / _KILOPASCAL
        axes.plot(x, values, style, color="0.2", linewidth=1.2, label=f"exact, row {name}")
        row = ahead & (side * y0 > 0.0)
        look = options | {"linestyle": "none", "markersize": 4}
        axes.plot(x0[row & ~frame], stress[row & ~frame], **look, label=f"SPH, row {name}")
        axes.plot(x0[row & frame], stress[row & frame], **look, markerfacecolor="white")
    axes.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
