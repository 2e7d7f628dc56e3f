"""The thesis's method and the total Lagrangian one beside each other: errors, and what they cost."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sphstudy.analysis.results import Missing, Results
from sphstudy.report.drawing import TEXT_WIDTH, plain_logarithmic
from sphstudy.report.figure import figure, figures
from sphstudy.report.series import PERCENT, RADIUS, curves, legend_above, ring_unstable, zero_line

METHODS = {"thesis": "thesis", "tl": "total Lagrangian"}
"""Methods that are compared, as the configuration and as a reader calls them, in the order of panels."""

_COMMON = 4.0
"""Errors that differ by more than this factor get scales of their own, and the panel says so."""

_SOLVERS: dict[tuple[str, str], tuple[str, dict[str, Any]]] = {
    ("thesis", "explicit"): ("thesis, stepped", {"marker": "o", "color": "C0"}),
    ("tl", "explicit"): ("total Lagrangian, stepped", {"marker": "^", "color": "C1"}),
    ("tl", "equilibrium"): ("total Lagrangian, solved directly", {"marker": "s", "color": "C2"}),
    ("tl", "modes"): ("total Lagrangian, solved directly", {"marker": "s", "color": "C2"}),
}
"""Method and solver: what they are called, and how they look."""

_HOLLOW: dict[str, Any] = {"markerfacecolor": "none"}
_FILLED: dict[str, Any] = {"markeredgecolor": "white", "markeredgewidth": 0.6}
"""How errors below and above zero look; a white edge tells filled markers apart where they overlap."""

_COSTS = {
    "plate": ("frequency_error_2d", "vibrating plate", "error of $\\omega$ against 2-D elasticity (%)"),
    "mode1": ("K_I_integral_error", "crack, mode I", "error of $K$ by integral (%)"),
    "mode2": ("K_II_integral_error", "crack, mode II", ""),
}
"""For each scene the error that is set against the cost, a title, and a label that both modes share."""


@figure(
    "frequency, side by side",
    "Relative error of the angular frequency ω of the vibrating plate against two-dimensional "
    "elasticity (finite elements) over the relative smoothing radius h̃, for each number n_y of rows, by "
    "both methods in explicit steps over one period. Where the largest errors of the two differ by more "
    "than a factor of 4, each panel has its own scale and says so. Rings: cells in the instability of "
    "the thesis's method, whose values react to anything. The thesis, against the beam: -3 to -25 %.",
)
def plate_frequency(results: Results) -> Figure:
    drawing = Figure(figsize=(TEXT_WIDTH, 3.3), layout="constrained")
    panels = drawing.subplots(1, 2)
    grids = _pair(results, panels, "plate", "frequency_error_2d", "n_y")
    # The thesis's own study knows which of its cells are unstable.
    ring_unstable(panels[0], results.other("plate"), grids[0])
    panels[0].set_ylabel("error of $\\omega$ against 2-D elasticity (%)")
    for axes, name in zip(panels, METHODS.values(), strict=True):
        axes.set_title(name)
    drawing.supxlabel(RADIUS, fontsize="medium")
    legend_above(drawing, panels[0], columns=4)
    return drawing


@figure(
    "error and cost",
    "Size of the error against the CPU time of a run (compilation left out), all h̃: frequency of the "
    "plate against two-dimensional elasticity, K_I and K_II of the cracks by an integral about the tip. "
    "Markers grow with the resolution n, which stands above each panel. Filled: too high; hollow: too "
    "low; where both are among neighbours, a small error is one that changes sign. Solved directly: "
    "modes of the plate, equilibrium of the cracks (three lengths of the crack). Below and left is "
    "better.",
)
def error_and_cost(results: Results) -> Figure:
    drawing = Figure(figsize=(TEXT_WIDTH, 3.5), layout="constrained")
    panels = drawing.subplots(1, 3)
    handles: dict[str, Any] = {}
    for axes, (scene, (metric, title, label)) in zip(panels, _COSTS.items(), strict=True):
        points = _measured(results, scene, metric)
        sizes = sorted(points["n"].unique())
        too_high = points[metric] > 0.0
        for (method, solver, n, high), cells in points.groupby(["method", "solve", "n", too_high]):
            name, options = _SOLVERS[method, solver]
            axes.loglog(
                cells["cpu_seconds"],
                PERCENT * cells[metric].abs(),
                linestyle="none",
                markersize=3.5 + 1.5 * sizes.index(n),
                **options | (_FILLED if high else _HOLLOW),
            )
            handles.setdefault(name, Line2D([], [], linestyle="none", **options, **_HOLLOW))
        which = ", ".join(str(n) for n in sizes)
        axes.set_title(f"{title}\n${'n_y' if scene == 'plate' else 'n_x'}$ = {which}")
        axes.set_ylabel(label)
    panels[2].sharey(panels[1])
    panels[2].tick_params(labelleft=False)
    for axis in (one for axes in panels for one in (axes.xaxis, axes.yaxis)):
        plain_logarithmic(axis)
    drawing.supxlabel("CPU time (s)", fontsize="medium")
    drawing.legend(handles.values(), handles.keys(), loc="outside upper center", ncols=3)
    return drawing


@figures(
    mode1_release_rates=(
        "energy release rate and stress intensity of mode I, side by side",
        "Mode I: relative errors over h̃ for each n_x of the energy release rate by propagation of the "
        "crack (G1), by projection of the displacements of its faces (G2), and of K_I by an integral "
        "over an annulus about the tip; the thesis's method stepped, the other solved for equilibrium. "
        "The panels of a row share a scale, or each has its own and says so, as for the plate. The "
        "thesis: G1 -18 to -30 %, but for (40, 1.5), G2 within 1 %.",
        1,
    ),
    mode2_release_rates=(
        "energy release rate and stress intensity of mode II, side by side",
        "Mode II: relative errors over h̃ for each n_x of G1 and G2 and of K_II by an integral over an "
        "annulus about the tip, as for mode I. The panels of a row share a scale, or each has its own "
        "and says so. The thesis: G1 -20 to -35 %, but for (40, 1.3), G2 3 to 4.5 %.",
        2,
    ),
)
def _release_rates(results: Results, mode: int) -> Figure:
    """A row of panels for each of G1, G2 and K, a column for each method."""
    roman = "I" * mode
    rows = {
        "G1_error": "error of $G_1$ (%)",
        "G2_error": "error of $G_2$ (%)",
        f"K_{roman}_integral_error": f"error of $K_\\mathrm{{{roman}}}$ by integral (%)",
    }
    drawing = Figure(figsize=(TEXT_WIDTH, 6.8), layout="constrained")
    panels = drawing.subplots(len(rows), 2)
    for pair, (metric, label) in zip(panels, rows.items(), strict=True):
        _pair(results, pair, f"mode{mode}", metric, "n_x")
        pair[0].set_ylabel(label)
    for axes, name in zip(panels[0], METHODS.values(), strict=True):
        axes.set_title(name)
    drawing.supxlabel(RADIUS, fontsize="medium")
    drawing.align_ylabels(panels[:, 0])
    legend_above(drawing, panels[0, 0], columns=3)
    return drawing


def _pair(results: Results, pair: np.ndarray, scene: str, metric: str, symbol: str) -> list[pd.DataFrame]:
    """Curves of a metric over h by each method in its panel, on one scale if that suits both.

    Zero belongs to every scale: what is shown is how far from it errors are. Returns what is drawn.
    """
    grids = [_grid(results, scene, method, metric) for method in METHODS]
    for axes, grid in zip(pair, grids, strict=True):
        curves(axes, grid, symbol)
        zero_line(axes)
    limits = np.array([axes.get_ylim() for axes in pair])
    sizes = [grid.abs().max(axis=None) for grid in grids]
    for axes in pair:
        if max(sizes) <= _COMMON * min(sizes):
            axes.set_ylim(limits.min(), limits.max())
        else:
            axes.set_title("own scale", loc="right", fontsize="small", color="0.3")
    return grids


def _grid(results: Results, scene: str, method: str, metric: str) -> pd.DataFrame:
    """Percent over h and n of one method. Raises Missing if there is not a single value."""
    block = "plate" if scene == "plate" else f"{scene}_{method}"
    try:
        return PERCENT * results.grid(metric, {"method": method}, block)
    except Missing as missing:
        raise Missing(f"{missing} by method {method}") from None


def _measured(results: Results, scene: str, metric: str) -> pd.DataFrame:
    """Points of a scene with this error and a cost, solved one way or another. Raises Missing if none."""
    # The method's own study has the runs of one of the two solvers.
    block = "modes" if scene == "plate" else "stepped"
    found = [results.select({"scene": scene}), results.other(f"tl_{scene}").select(block=block)]
    columns = ["record", "method", "solve", "n", metric, "cpu_seconds"]
    points = pd.concat([one.reindex(columns=columns) for one in found]).drop_duplicates("record")
    points = points.dropna(subset=[metric, "cpu_seconds"])
    if points.empty:
        raise Missing(f"{results.name}: no point of scene {scene} has {metric}")
    return points
