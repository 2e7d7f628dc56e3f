"""Time steps: the largest stable one over h, and what the error says of shorter ones."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sphstudy.analysis import time_steps
from sphstudy.analysis.results import Missing, Results
from sphstudy.analysis.time_steps import HARMLESS
from sphstudy.report.drawing import TEXT_WIDTH
from sphstudy.report.figure import figure
from sphstudy.report.series import MARKERS, PERCENT, RADIUS

PANELS = {
    ("tl", "verlet"): "total Lagrangian, Verlet",
    ("tl", "heun"): "total Lagrangian, Heun",
    ("thesis", "heun"): "thesis, Heun",
}
"""Method and integrator: what they are called. With viscosity, but for Verlet's method."""

_ARROW = "$\\downarrow$"

_FLOOR = 1e-6
"""Smaller changes are drawn here: the fit of a frequency to samples has no more digits."""


@figure(
    "largest stable time step",
    "Largest stable time step as C of Δt = C Δ/c0 (2.27) over the relative smoothing radius, by "
    "bisection to 0.5 %: the body at rest is shaken by a hundred-thousandth of the wave speed, and must "
    "not gain energy in 4000 steps. Verlet's method has no viscosity, Heun's the linear one of (2.21). "
    "Dashed: 2/ω_max, by power iteration on the stiffness, Verlet's limit without damping. Arrows: "
    "without viscosity, unstable at every C tried, down to there: Heun's method multiplies the energy of "
    "an undamped mode by 1 + (ω Δt)⁴/4 in a step, whatever the step.",
)
def limits(results: Results) -> Figure:
    found = time_steps.limits(results.table)
    found = found[found["n"] == found["n"].min()]
    panels = [panel for panel in PANELS if not _of(found, panel).empty]
    if not panels:
        raise Missing(f"{results.name}: no largest stable step is stored")
    drawing = Figure(figsize=(TEXT_WIDTH, 3.4), layout="constrained")
    ratios = sorted(found["nu"].unique())
    for axes, panel in _axes(drawing, panels):
        own = _of(found, panel)
        for number, nu in enumerate(ratios):
            _limit(axes, own[own["nu"] == nu].sort_values("h"), number)
        axes.set_xticks(sorted(found["h"].unique()))
    drawing.axes[0].set(ylim=(0.0, None), ylabel="largest stable $C$")
    drawing.supxlabel(RADIUS, fontsize="medium")
    handles = [
        Line2D([], [], linestyle=":", color=f"C{k}", marker=MARKERS[k], label=f"$\\nu = {nu:g}$")
        for k, nu in enumerate(ratios)
    ]
    handles.append(Line2D([], [], linestyle="--", color="0.4", label="$2/\\omega_\\mathrm{max}$"))
    if found["found"].isna().any():
        arrow: dict[str, Any] = {"linestyle": "none", "marker": _ARROW, "color": "0.4", "markersize": 8}
        handles.append(Line2D([], [], **arrow, label="none, without viscosity"))
    drawing.legend(handles=handles, loc="outside upper center", ncols=len(handles))
    return drawing


def _limit(axes: Axes, own: pd.DataFrame, number: int) -> None:
    """Limits of one panel and ν, in the colour and with the marker of that number."""
    look: dict[str, Any] = {"color": f"C{number}"}
    with_limit = own.dropna(subset=["found"])
    axes.plot(with_limit["h"], with_limit["predicted"], "--", **look, linewidth=1.2)
    axes.plot(with_limit["h"], with_limit["found"], ":", marker=MARKERS[number], **look, linewidth=1.0)
    none = own[own["found"].isna()]
    # Side by side: limits that were not found all lie at the same height.
    shift = 0.04 * (number - 1)
    axes.plot(none["h"] + shift, none["lowest"], linestyle="none", marker=_ARROW, markersize=8, **look)


@figure(
    "time step and error",
    "How far the error of the plate's frequency against two-dimensional elasticity is from that with the "
    "shortest step, over the size of the latter, against the time step over the largest stable one. "
    "Dotted: a tenth of the error that the discretisation in space makes. Rings: the longest step worth "
    "taking, with its C: stable, and no shorter one is off by more. Crosses along the upper edge: runs "
    "that diverged. What varies below 10⁻⁴ is the fit of ω to samples; below 10⁻⁶ it is drawn there.",
)
def worth(results: Results) -> Figure:
    found = time_steps.changes(results.table)
    panels = [panel for panel in PANELS if not _of(found, panel).empty]
    if not panels:
        raise Missing(f"{results.name}: no runs at shares of a largest stable step are stored")
    best = time_steps.worth(found)
    drawing = Figure(figsize=(TEXT_WIDTH, 4.0), layout="constrained")
    for axes, panel in _axes(drawing, panels):
        rings = _of(best, panel)
        for number, (h, own) in enumerate(_of(found, panel).groupby("h")):
            _change(axes, own, rings[rings["h"] == h], number, float(h))
        axes.axhline(HARMLESS, linestyle=":", color="0.3", zorder=1)
        axes.axvline(1.0, color="0.6", linewidth=0.8, zorder=1)
        axes.set(xscale="log", yscale="log", xlabel="$\\Delta t$ over the largest stable one")
        axes.legend(loc="upper left", fontsize="x-small", title="worth taking", title_fontsize="x-small")
        axes.set_xticks([0.1, 0.2, 0.5, 1.0], ["0.1", "0.2", "0.5", "1"])
        axes.minorticks_off()
    drawing.axes[0].set(ylim=(0.5 * _FLOOR, 100.0), ylabel="change of the error of $\\omega$, relative")
    return drawing


def _change(axes: Axes, own: pd.DataFrame, best: pd.DataFrame, number: int, h: float) -> None:
    """Runs of one scheme and h; `best`: the row that is worth taking, or none."""
    look: dict[str, Any] = {"color": f"C{number}", "marker": MARKERS[number]}
    error = f"{PERCENT * own['error'].iloc[0]:+.1f}".replace("-", "−")
    label = f"$\\tilde{{h}}={h:g}$ (error {error} %): "
    label += f"C = {best['courant'].iloc[0]:.2f}" if len(best) else "none"
    done = own[own["status"] == "done"].iloc[1:]
    axes.plot(done["share"], np.maximum(done["change"], _FLOOR), **look, linewidth=1.0, label=label)
    failed = own[own["status"] == "diverged"]
    axes.plot(failed["share"], np.full(len(failed), 10.0 * 1.7**number), "x", color=f"C{number}")
    ring: dict[str, Any] = {"markersize": 11, "markerfacecolor": "none", "markeredgecolor": f"C{number}"}
    axes.plot(best["share"], np.maximum(best["change"], _FLOOR), "o", **ring, zorder=4)


def _axes(drawing: Figure, panels: list[tuple[str, str]]) -> Iterator[tuple[Axes, tuple[str, str]]]:
    """Axes side by side with the same scales, one for each panel."""
    row = drawing.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
    for axes, panel in zip(row, panels, strict=True):
        axes.set_title(PANELS[panel])
        yield axes, panel


def _of(found: pd.DataFrame, panel: tuple[str, str]) -> pd.DataFrame:
    return found[(found["method"] == panel[0]) & (found["integrator"] == panel[1])]
