"""Tests of the thesis's conjectures: tensile instability of the plate, lost antisymmetry of mode II."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sphstudy.analysis.results import Missing, Results
from sphstudy.metrics.roughness import VISIBLE
from sphstudy.numerics.sph.kernel import KERNELS, curvature
from sphstudy.report.figure import figure
from sphstudy.report.series import PERCENT, RADIUS, legend_above, zero_line

_STRESS = "method.artificial_stress"
_PLACES = "relative smoothing radius $\\tilde{h}$, kernel"

_LOOKS: tuple[dict[str, Any], ...] = (
    {"marker": "o", "color": "#0072B2"},
    {"marker": "D", "color": "#D55E00", "markerfacecolor": "none", "markersize": 7},
)
"""Of the two things compared: hollow over filled, so that both show where they coincide."""


@figure(
    "curvature of the kernels",
    "Second derivative of each kernel over q = r/h, and where the nearest neighbour sits at each "
    "relative smoothing radius, q = 1/h̃. A pair of particles is unstable in tension where the "
    "curvature is positive, in compression where it is negative (Swegle, Hicks & Attaway 1995).",
)
def kernel_curvature(results: Results) -> Figure:
    names = results.select(block="plate")["method.kernel"].unique()
    widths = np.sort(results.table["h"].unique())
    neighbours, q = 1.0 / widths, np.linspace(0.25, 2.25, 300)
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    for name, style, marker in zip(names, ("-", "--", "-."), "os^", strict=False):
        kernel = KERNELS[name]
        # α = scale/h²: kernels compare at equal h.
        values = [kernel.scale * curvature(kernel, value) for value in np.append(neighbours, q)]
        (line,) = axes.plot(q, values[neighbours.size :], style, label=name)
        axes.plot(neighbours, values[: neighbours.size], marker, color=line.get_color())
    zero_line(axes)
    for h, neighbour in zip(widths, neighbours, strict=True):
        axes.axvline(neighbour, color="0.6", linewidth=1.0, linestyle=":", zorder=1)
        place: dict[str, Any] = {"xycoords": axes.get_xaxis_transform(), "textcoords": "offset points"}
        text: dict[str, Any] = {"rotation": 90, "ha": "right", "fontsize": 8, "color": "0.3"}
        axes.annotate(f"$\\tilde{{h}} = {h:g}$", (neighbour, 0.0), (-1, 4), **place, **text)
    axes.set(
        xlabel="$q = r/h$",
        ylabel="curvature $h^4\\,\\mathrm{d}^2W/\\mathrm{d}r^2$",
        xlim=(q[0], q[-1]),
        ylim=(-1.1, 0.8),
    )
    for height, state in ((0.45, "tension"), (-0.15, "compression")):
        axes.text(q[-1], height, f"unstable in {state}", ha="right", va="center", color="0.3")
    legend_above(drawing, axes, columns=3)
    return drawing


@figure(
    "spikes",
    "Particle-to-particle roughness of the von Mises stress of the vibrating plate near the wall, "
    "below (in tension) and above the axis, a quarter of a period after the start, n_y = 15; upper "
    "row: the load of the thesis, lower row: a thousandth. Spikes are seen in a drawing above the "
    "dashed line. The thesis suspects tensile instability.",
)
def spikes(results: Results) -> Figure:
    sides = {"stress_roughness_bottom": "below the axis", "stress_roughness_top": "above the axis"}
    points = _points(results, ["plate"], list(sides))
    loads = sorted(points["scene.H0"].unique(), reverse=True)
    places = _places(points)
    drawing = Figure(figsize=(6.6, 4.8), layout="constrained")
    panels = drawing.subplots(len(loads), 2, sharex=True, sharey=True, squeeze=False)
    for line, load in zip(panels, loads, strict=True):
        for axes, (metric, where) in zip(line, sides.items(), strict=True):
            chosen = points[points["scene.H0"] == load].set_index(["method.kernel", "h", _STRESS])[metric]
            for label, stress, options in _artificial(points):
                values = [PERCENT * chosen.get((*place, stress), np.nan) for place in places]
                axes.semilogy(values, linestyle="", **options, label=label)
            axes.axhline(PERCENT * VISIBLE, color="0.4", linestyle="--", linewidth=0.8, zorder=1)
            axes.set_title(f"{where}, load × {load / loads[0]:g}")
            _name_places(axes, places)
        line[0].set_ylabel("roughness (%)")
    drawing.supxlabel(_PLACES, fontsize="medium")
    legend_above(drawing, panels[0, 0], columns=2)
    return drawing


@figure(
    "clumping",
    "Spread (standard deviation over mean) of the distances to the nearest neighbour in the bent plate "
    "near the wall, below (in compression) and above the axis (in tension), at the end of a run of 160 "
    "s, n_y = 7. Clumped particles have a large spread. The thesis suspects tensile instability, though "
    "its particles clump on the compressed side.",
)
def clumping(results: Results) -> Figure:
    sides = {"spacing_spread_bottom": "below the axis", "spacing_spread_top": "above the axis"}
    points = _points(results, ["bending_kernel", "bending_load"], list(sides))
    loads = sorted(points["scene.deflection"].unique(), key=abs, reverse=True)
    places = _places(points)
    drawing = Figure(figsize=(6.6, 3.6), layout="constrained")
    panels = drawing.subplots(1, 2, sharey=True)
    for axes, (metric, where) in zip(panels, sides.items(), strict=True):
        for load, options in zip(loads, _LOOKS, strict=False):
            chosen = points[points["scene.deflection"] == load].set_index(["method.kernel", "h"])[metric]
            values = [PERCENT * chosen.get(place, np.nan) for place in places]
            axes.semilogy(values, linestyle="", **options, label=f"load × {load / loads[0]:g}")
        axes.set_title(where)
        _name_places(axes, places)
    panels[0].set_ylabel("spread of spacings (%)")
    drawing.supxlabel(_PLACES, fontsize="medium")
    legend_above(drawing, panels[0], columns=2)
    return drawing


@figure(
    "lost antisymmetry",
    "Mode II, n_x = 40: the part of σ_xx and σ_yy that is even in y over the part that is odd, rms in "
    "the two rows ahead of the tip, at the load of the thesis and at a thousandth of it, with "
    "artificial stress and without. Exactly, they are odd. The thesis sees that they are not and "
    "cannot say why.",
)
def antisymmetry(results: Results) -> Figure:
    fields = {"xx": "$\\sigma_{xx}$", "yy": "$\\sigma_{yy}$"}
    metrics = {f"stress_{name}_parity_defect_ahead": symbol for name, symbol in fields.items()}
    points = _points(results, ["mode2"], list(metrics))
    loads = sorted(points["scene.K"].unique(), reverse=True)
    drawing = Figure(figsize=(6.6, 3.6), layout="constrained")
    panels = drawing.subplots(1, len(metrics), sharey=True)
    for axes, (metric, symbol) in zip(panels, metrics.items(), strict=True):
        for load, (style, marker) in zip(loads, (("-", "o"), (":", "v")), strict=False):
            for label, stress, options in _artificial(points):
                chosen = points[(points["scene.K"] == load) & (points[_STRESS] == stress)]
                curve = chosen.sort_values("h")
                name = f"load × {load / loads[0]:g}, {label}"
                axes.semilogy(
                    curve["h"], PERCENT * curve[metric], style, **options | {"marker": marker}, label=name
                )
        axes.set_title(symbol)
        widths = np.sort(points["h"].unique())
        axes.set(xticks=widths, xlim=(widths[0] - 0.05, widths[-1] + 0.05))
    panels[0].set_ylabel("even part over odd part (%)")
    drawing.supxlabel(RADIUS, fontsize="medium")
    legend_above(drawing, panels[0], columns=2)
    return drawing


def _points(results: Results, blocks: list[str], metrics: list[str]) -> pd.DataFrame:
    """The points of blocks with these metrics, NaN where one is not there. Raises Missing if none is."""
    columns = results.table.columns.union(metrics, sort=False)
    points = results.table[results.table["block"].isin(blocks)].reindex(columns=columns)
    if points[metrics].isna().all(axis=None):
        raise Missing(f"{results.name}: no point of block {', '.join(blocks)} has {metrics[0]}")
    return points


def _places(points: pd.DataFrame) -> list[tuple[str, float]]:
    """Kernel and h of the points, in the order in which they stand along an axis."""
    places = set(zip(points["method.kernel"], points["h"], strict=True))
    return sorted(places, key=lambda place: (list(KERNELS).index(place[0]), place[1]))


def _name_places(axes: Axes, places: list[tuple[str, float]]) -> None:
    """Names the places along the axis: h, and below the middle of each kernel's places its name."""
    names = [kernel for kernel, _ in places]
    middles = {name: names.index(name) + 0.5 * (names.count(name) - 1) for name in names}
    axes.set_xlim(-0.5, len(places) - 0.5)
    axes.set_xticks(range(len(places)), [f"{h:g}" for _, h in places])
    axes.set_xticks(list(middles.values()), list(middles), minor=True)
    axes.tick_params("x", which="minor", length=0, pad=17)


def _artificial(points: pd.DataFrame) -> list[tuple[str, float, dict[str, Any]]]:
    """For each strength of the artificial stress: what it is called, the strength, and how it looks."""
    strengths = sorted(points[_STRESS].unique())
    names = ["without artificial stress" if zeta == 0.0 else f"$\\zeta = {zeta:g}$" for zeta in strengths]
    return list(zip(names, strengths, _LOOKS, strict=False))
