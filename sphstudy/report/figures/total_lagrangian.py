"""The total Lagrangian method by itself: how its errors fall, and what it does to the particles."""

from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sphstudy.analysis.results import Missing, Results
from sphstudy.analysis.richardson import extrapolate
from sphstudy.metrics.regularity import EARLY
from sphstudy.report.drawing import TEXT_WIDTH, plain_logarithmic
from sphstudy.report.figure import figure, figures
from sphstudy.report.figures import bending, crack_field
from sphstudy.report.figures.crack_field import OPENING, SLIDING, caption
from sphstudy.report.figures.von_mises import snapshot_at
from sphstudy.report.series import MARKERS, PERCENT, RADIUS, curves, legend_above, zero_line

_METHOD = "total Lagrangian, "
_MILLIMETRE = 1e-3

_FINEST = 41
"""Rows of the finest plate, whose modes alone are computed."""

_H = 1.3
"""h̃ at which the cracks are refined beyond the grid."""


@figure(
    "frequency, total Lagrangian",
    "Relative error of the angular frequency ω of the vibrating plate against two-dimensional "
    "elasticity over the relative smoothing radius h̃: fitted to one period in explicit steps for the "
    "thesis's numbers n_y of rows, and of the lowest mode, solved directly, for n_y = 41. The thesis, by "
    "its own method and against the beam: -3 to -25 %.",
)
def plate_frequency(results: Results) -> Figure:
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    curves(axes, PERCENT * results.grid("frequency_error_2d"), "n_y")
    modes = PERCENT * results.grid("frequency_error_2d", {"n": _FINEST}, "modes")[_FINEST]
    options: dict[str, Any] = {"color": "C3", "marker": "D", "markerfacecolor": "none"}
    axes.plot(modes.index, modes, "--", **options, label=f"$n_y = {_FINEST}$, modes")
    zero_line(axes)
    axes.set(xlabel=RADIUS, ylabel="error of $\\omega$ against 2-D elasticity (%)")
    legend_above(drawing, axes, columns=4)
    return drawing


@figure(
    "refinement of the plate, total Lagrangian",
    "Size of the relative error of ω against two-dimensional elasticity over the spacing Δ = D/n_y of "
    "the rows, from the modes, n_y = 9, 15, 21, 41, for each h̃. Filled: ω too high; hollow: too low; "
    "a gap in a line: the error changes sign there. Dotted: first and second order.",
)
def plate_refinement(results: Results) -> Figure:
    grid = PERCENT * _over_spacing(results, "frequency_error_2d", "modes")
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    for number, (h, errors) in enumerate(grid.items()):
        _signed(axes, errors.dropna(), f"C{number}", MARKERS[number % len(MARKERS)], h)
    for name, face in (("too high", "0.4"), ("too low", "white")):
        axes.plot([], [], "o", color="0.4", markerfacecolor=face, label=f"$\\omega$ {name}")
    axes.set(xscale="log", yscale="log")
    _orders(axes, grid)
    plain_logarithmic(axes.yaxis)
    axes.set(xlabel="spacing $\\Delta = D/n_y$ (mm)", ylabel="size of the error of $\\omega$ (%)")
    axes.set_xticks(grid.index, [f"{spacing:.1f}" for spacing in grid.index])
    axes.minorticks_off()
    legend_above(drawing, axes, columns=3)
    return drawing


@figure(
    "positions of the bent plate, total Lagrangian",
    "Particles of the bent plate beside the wall, x < 0.3 m, 11 s and 150 s after the start, total "
    "Lagrangian in explicit steps, n_y = 9, h̃ = 1.7, each particle at half its size, with the smallest "
    "distance between two of them (at rest Δy, a little less than Δx). The thesis, by its own method: "
    "fairly regular at 11 s, clumped in lines after 150 s.",
)
def bending_held(results: Results) -> Figure:
    run = results.record(block="held")
    states = [(f"$t = {time:g}$ s", snapshot_at(run, time)) for time in (EARLY, bending.LONG)]
    return bending.beside_wall(states)


@figure(
    "energy and end angle of the bent plate, total Lagrangian",
    "Bent plate at equilibrium: relative error of the strain energy and error of the angle of the driven "
    "end, both against two-dimensional elasticity (finite elements), over the spacing Δ = D/n_y, n_y = "
    "9, 15, 21, for each h̃. The thesis compares the angle with the beam: an error of order 0.1°.",
)
def bending_energy(results: Results) -> Figure:
    drawing = Figure(figsize=(TEXT_WIDTH, 3.3), layout="constrained")
    panels = drawing.subplots(1, 2)
    quantities = {
        "bending_energy_error": (PERCENT, "error of strain energy (%)"),
        "end_angle_error_2d": (1.0, "error of end angle (degrees)"),
    }
    for axes, (metric, (factor, label)) in zip(panels, quantities.items(), strict=True):
        for number, (h, errors) in enumerate(_over_spacing(results, metric, "grid").items()):
            marker = MARKERS[number % len(MARKERS)]
            axes.plot(errors.index, factor * errors, marker=marker, label=f"$\\tilde{{h}} = {h:g}$")
        zero_line(axes)
        axes.set(ylabel=label)
        axes.set_xlim(left=0.0)
    drawing.supxlabel("spacing $\\Delta = D/n_y$ (mm)", fontsize="medium")
    legend_above(drawing, panels[0], columns=4)
    return drawing


@figures(
    mode1_field=("deformed square, opening, total Lagrangian", caption(*OPENING, _METHOD), "yy"),
    mode2_field=("deformed square, sliding, total Lagrangian", caption(*SLIDING, _METHOD), "xy"),
)
def _field(results: Results, component: str) -> Figure:
    return crack_field.draw(results, component)


def _over_spacing(results: Results, metric: str, block: str) -> pd.DataFrame:
    """A metric of a plate over Δ = D/n (mm, index) and h (columns), NaN where it is missing."""
    grid = results.grid(metric, block=block)
    scene = results.config_at(results.select(block=block).index[0]).scene
    height = scene.L / scene.slenderness
    return grid.T.set_axis(height / grid.columns.to_numpy() / _MILLIMETRE, axis="index")


def _signed(axes: Axes, errors: pd.Series, colour: str, marker: str, h: float) -> None:
    """Sizes of errors over their index, filled where positive; no line across a change of sign."""
    points = list(errors.items())
    for (first, before), (second, after) in pairwise(points):
        if before * after > 0.0:
            axes.plot([first, second], [abs(before), abs(after)], color=colour)
    for positive in (True, False):
        chosen = errors[(errors > 0.0) == positive].abs()
        options: dict[str, Any] = {"linestyle": "none", "marker": marker, "color": colour}
        axes.plot(
            chosen.index, chosen, **options, markerfacecolor=colour if positive else "white", zorder=3
        )
    # In the legend the shape tells h, filled or not.
    axes.plot([], [], color=colour, marker=marker, label=f"$\\tilde{{h}} = {h:g}$")


def _orders(axes: Axes, grid: pd.DataFrame) -> None:
    """Lines of first and second order that end above the coarsest data, named at the left."""
    finest, coarsest = grid.index.min(), grid.index.max()
    top = 1.5 * grid.abs().max(axis=None)
    for order, name in ((1, "$\\propto\\Delta$"), (2, "$\\propto\\Delta^2$")):
        low = top * (finest / coarsest) ** order
        axes.plot([finest, coarsest], [low, top], ":", color="0.4", linewidth=1.2)
        place: dict[str, Any] = {"textcoords": "offset points", "ha": "right", "va": "center"}
        axes.annotate(name, (finest, low), (-4, 0), **place, color="0.3")
    axes.set_xlim(left=finest / 1.18)


@figures(
    mode1_stress_intensity=(
        "stress intensity of mode I over the spacing, total Lagrangian",
        "Mode I at equilibrium, h̃ = 1.3: errors of K_I and J by integrals over an annulus about the "
        "tip and of G1 by propagation of the crack over the spacing Δx = L/n_x, n_x = 40, 50, 60, 80, "
        "120. Lines: first order through the two finest. Hollow: what this makes of the error at Δx = "
        "0; on the right the same magnified, with its uncertainty. An error that is of first order and "
        "nothing else lies on a line through the origin.",
        "I",
    ),
    mode2_stress_intensity=(
        "stress intensity of mode II over the spacing, total Lagrangian",
        "Mode II at equilibrium, h̃ = 1.3: errors of K_II, J and G1 over the spacing, drawn as for mode "
        "I.",
        "II",
    ),
)
def _refined(results: Results, roman: str) -> Figure:
    """Errors of K, J and G1 over the spacing, and what they tend to as it goes to zero."""
    quantities = {
        f"K_{roman}_integral_error": f"$K_\\mathrm{{{roman}}}$",
        "J_error": "$J$",
        "G1_error": "$G_1$",
    }
    drawing = Figure(figsize=(TEXT_WIDTH, 3.7), layout="constrained")
    over_spacing, at_zero = drawing.subplots(1, 2, width_ratios=(3.0, 1.0))
    for number, (metric, symbol) in enumerate(quantities.items()):
        points = _points(results, metric)
        spacings = points["spacing"].to_numpy() / _MILLIMETRE
        errors = PERCENT * points[metric].to_numpy()
        look: dict[str, Any] = {"color": f"C{number}", "marker": MARKERS[number]}
        over_spacing.plot(spacings, errors, linestyle="none", label=symbol, **look)
        limit = extrapolate(spacings, errors, order=1.0)
        if np.isfinite(limit.value):
            slope = (limit.values[-1] - limit.value) / limit.spacings[-1]
            ends = np.array([0.0, limit.spacings[0]])
            over_spacing.plot(ends, limit.value + slope * ends, color=f"C{number}", linewidth=1.0)
            hollow = look | {"markerfacecolor": "white", "zorder": 4}
            over_spacing.plot([0.0], [limit.value], **hollow)
            at_zero.errorbar([number], [limit.value], [limit.uncertainty], **hollow, capsize=4)
    for axes in (over_spacing, at_zero):
        zero_line(axes)
    over_spacing.set(xlabel="spacing $\\Delta x = L/n_x$ (mm)", ylabel="relative error (%)")
    at_zero.set(title="at $\\Delta x = 0$", xlim=(-0.5, len(quantities) - 0.5))
    at_zero.set_xticks(range(len(quantities)), list(quantities.values()))
    legend_above(drawing, over_spacing, columns=3)
    return drawing


def _points(results: Results, metric: str) -> pd.DataFrame:
    """The points of the grid and of the refinement at the h of the latter that have this metric."""
    chosen = results.select({"h": _H})
    chosen = chosen[chosen["block"].isin(["grid", "refined"])].drop_duplicates("record")
    if metric not in chosen or chosen[metric].isna().all():
        raise Missing(f"{results.name}: no point with h={_H:g} has {metric}")
    return chosen.dropna(subset=[metric]).sort_values("spacing", ascending=False)
