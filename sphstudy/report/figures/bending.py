"""Bending plate: centreline at rest, positions of its particles then and much later (thesis 4.2)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from sphstudy.analysis.results import Missing, Results
from sphstudy.metrics.metric import snapshot
from sphstudy.metrics.regularity import nearest_distances
from sphstudy.model.exact import beam
from sphstudy.report.drawing import TEXT_WIDTH, footprints, spacing
from sphstudy.report.figure import figure, figures
from sphstudy.report.series import legend_above, zero_line
from sphstudy.store.record import configuration

_CELL = {"h": 1.7, "n": 21}
_MILLIMETRE = 1e-3

LONG = 150.0
"""Time (s) after which the thesis looks again."""

NEAR = 0.3
"""Length of the part beside the wall that the thesis shows, in units of L."""


@figure(
    "4.6",
    "Centreline of the bent plate in cell (n_y, h̃) = (21, 1.7) at t = 11 s (every fourth particle), "
    "with the beam's formula; below, the difference of the two, all particles. The thesis: the "
    "agreement is very good.",
)
def centreline(results: Results) -> Figure:
    x0, u_y, exact = _centreline(results)
    drawing = Figure(figsize=(5.6, 4.4), layout="constrained")
    shape, difference = drawing.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    shape.plot(x0[::4], u_y[::4] / _MILLIMETRE, "o", markersize=4, label="SPH")
    shape.plot(x0, exact / _MILLIMETRE, "--", color="0.2", label="beam")
    shape.set_ylabel("displacement $u_y$ (mm)")
    difference.plot(x0, (u_y - exact) / _MILLIMETRE)
    zero_line(difference)
    difference.set(xlabel="$x_0$ (m)", ylabel="SPH - beam (mm)")
    legend_above(drawing, shape, columns=2)
    return drawing


@figure(
    "4.8",
    "Positions of the particles of the bent plate in cell (n_y, h̃) = (21, 1.7) at t = 11 s: whole, "
    "and 0 < x < 0.3 m, each particle at half its size. The thesis: fairly regular, with a slight "
    "tendency to clump.",
)
def positions(results: Results) -> Figure:
    run = results.record(_CELL, block="grid")
    return _positions(run, snapshot(run, "settle"))


@figure(
    "4.9",
    "Positions of the particles of the bent plate more than 150 s after the start (resolution and time "
    "above the figure): whole, and 0 < x < 0.3 m, each particle at half its size. The thesis, n_y = "
    "21: irregular for x < 0.3 m, clumped in lines at the bottom (y < 0).",
)
def positions_long_after(results: Results) -> Figure:
    run = results.record(block="grid")
    state = run.isel(snapshot=-1)
    if float(state["snapshot_time"]) < LONG:
        raise Missing(f"{run.attrs['title']}: no snapshot after t = {LONG:g} s")
    return _positions(run, state)


def _centreline(results: Results) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x0, u_y and the beam's u_y [M] (m) of the centreline at rest."""
    run = results.record(_CELL, block="grid")
    scene, state = configuration(run).scene, snapshot(run, "settle")
    centre = run["tag_centreline"].values == 1
    x0 = run["reference_x"].values[centre]
    u_y = (state["y"].values - run["reference_y"].values)[centre]
    deflection = scene.deflection * scene.L
    return x0, u_y, beam.bent_centreline(x0, deflection, scene.L, float(run["spacing_x"]))


@figures(
    centreline_wall=(
        "4.7a",
        "The centreline of figure 4.6 beside the wall, x0 < 0.15 m, all particles. The thesis: a "
        "boundary effect can be seen close to the wall.",
        0.0,
        0.15,
    ),
    centreline_end=(
        "4.7b",
        "The centreline of figure 4.6 at the driven end, x0 > 0.9 m, all particles. The thesis: a "
        "boundary effect can be seen at the end.",
        0.9,
        1.0,
    ),
)
def _part(results: Results, start: float, stop: float) -> Figure:
    """The centreline between two x0 (m)."""
    x0, u_y, exact = _centreline(results)
    part = (x0 >= start) & (x0 <= stop)
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    axes.plot(x0[part], u_y[part] / _MILLIMETRE, "o", markersize=4, label="SPH")
    axes.plot(x0[part], exact[part] / _MILLIMETRE, "--", color="0.2", label="beam")
    axes.set(xlabel="$x_0$ (m)", ylabel="displacement $u_y$ (mm)")
    legend_above(drawing, axes, columns=2)
    return drawing


def beside_wall(states: list[tuple[str, xr.Dataset]]) -> Figure:
    """Panels of the particles beside the wall, each at half its size.

    Parameters
    ----------
    states : list of (title, xarray.Dataset)
        For each panel: a title, below which stands the smallest distance between two particles there,
        over Δx; and the record of a plate at one snapshot.
    """
    drawing = Figure(figsize=(TEXT_WIDTH, 1.9), layout="constrained")
    panels = drawing.subplots(1, len(states), sharex=True, sharey=True)
    edges, end = [], NEAR * configuration(states[-1][1]).scene.L
    for axes, (title, state) in zip(panels, states, strict=True):
        x, y = state["x"].values, state["y"].values
        size = np.array(spacing(state))
        near = x < end
        footprints(axes, x[near], y[near], *(0.5 * size), facecolor="C0", linewidth=0.0)
        closest = nearest_distances(x, y)[near].min() / size[0]
        edges.append((x.min() - size[0], end + size[0], y[near].min() - size[1], y[near].max() + size[1]))
        axes.set_title(f"{title}\nclosest pair: {closest:.3f} $\\Delta x$")
        axes.set(xlabel="$x$ (m)", aspect="equal")
        axes.locator_params("x", nbins=4)
        axes.grid(False)
    left, right, bottom, top = zip(*edges, strict=True)
    panels[0].set(xlim=(min(left), max(right)), ylim=(min(bottom), max(top)), ylabel="$y$ (m)")
    return drawing


def _positions(run: xr.Dataset, state: xr.Dataset) -> Figure:
    config = configuration(run)
    x, y = state["x"].values, state["y"].values
    size = np.array(spacing(run))
    drawing = Figure(figsize=(5.6, 3.1), layout="constrained")
    whole, wall = drawing.subplots(2, 1, height_ratios=(1.0, 2.4))
    # At the scale of the whole, gaps between the particles would beat with the pixels.
    footprints(whole, x, y, *size, facecolor="C0", linewidth=0.8)
    footprints(wall, x, y, *(0.5 * size), facecolor="C0", linewidth=0.0)
    near = x < NEAR * config.scene.L
    for axes, chosen, end in (
        (whole, x < np.inf, x.max() + size[0]),
        (wall, near, NEAR * config.scene.L),
    ):
        low, high = y[chosen].min(), y[chosen].max()
        axes.set(xlim=(x.min() - size[0], end), ylim=(low - size[1], high + size[1]))
        axes.set(ylabel="$y$ (m)", aspect="equal")
        axes.grid(False)
    wall.set_xlabel("$x$ (m)")
    time = float(state["snapshot_time"])
    whole.set_title(f"$n_y = {config.n}$, $\\tilde{{h}} = {config.h:g}$, $t = {time:.4g}$ s")
    return drawing
