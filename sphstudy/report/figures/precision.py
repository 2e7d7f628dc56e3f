"""Work and precision: error against CPU time of every stored point of a scene, and predicted cost."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sphstudy.analysis import cost_forecast
from sphstudy.analysis.cost_forecast import Measurement, Rates
from sphstudy.analysis.results import Missing, Results
from sphstudy.analysis.work_precision import ERRORS, front, points
from sphstudy.report.drawing import TEXT_WIDTH, plain_logarithmic
from sphstudy.report.figure import figure, figures
from sphstudy.report.series import PERCENT

_LOOKS: dict[tuple[str, str], tuple[str, dict[str, Any]]] = {
    ("thesis", "explicit"): ("thesis, stepped", {"marker": "o", "color": "C0"}),
    ("tl", "explicit"): ("total Lagrangian, stepped", {"marker": "^", "color": "C1"}),
    ("tl", "equilibrium"): ("total Lagrangian, equilibrium", {"marker": "s", "color": "C2"}),
    ("tl", "modes"): ("total Lagrangian, modes", {"marker": "D", "color": "C2"}),
}
"""Method and solver: what they are called, and how they look."""

_WITHIN = 0.3
"""Relative error of a good prediction."""

_LOWER = 0.92
"""A point of the front has its name if its error is below this share of the last named one."""

_SEVERAL = 3
"""Resolutions from which on a series ends in its h."""

_HOW = (
    "Every point by its CPU time, compilation left out. Thin lines join resolutions n with all other "
    "settings the same, and end in h̃ where there are three or more; markers grow with n. Hollow: lucky, "
    "that is, a finer resolution with the same settings is clearly farther off. Black: the Pareto front "
    "of points that a finer resolution confirms, with (n, h̃), by the largest error of the point and of "
    "all finer ones. Crosses on the upper edge: runs that diverged, at what they cost until then. Below "
    "and left is better."
)


@figure(
    "predicted cost",
    "CPU time predicted for each run from all the others over the time that it took, against that time. "
    "Shaded: within 30 %. The share of runs inside stands above.",
)
def predicted_cost(results: Results) -> Figure:
    found = _left_out(results)
    ratios = found["predicted"] / found["taken"]
    drawing = Figure(figsize=(TEXT_WIDTH, 3.4), layout="constrained")
    axes = drawing.subplots()
    axes.axhspan(1.0 - _WITHIN, 1.0 + _WITHIN, color="0.9", zorder=0)
    axes.axhline(1.0, color="0.4", linewidth=0.8, zorder=1)
    for kind, rows in found.groupby(["method", "solve"]):
        name, look = _LOOKS[kind]
        axes.loglog(rows["taken"], ratios[rows.index], linestyle="none", label=name, markersize=4, **look)
    inside = int((abs(ratios - 1.0) <= _WITHIN).sum())
    axes.set_title(f"{inside} of {len(ratios)} runs within {PERCENT * _WITHIN:.0f} %")
    axes.set(xlabel="CPU time taken (s)", ylabel="predicted over taken")
    plain_logarithmic(axes.xaxis)
    plain_logarithmic(axes.yaxis)
    drawing.legend(loc="outside upper center", ncols=2)
    return drawing


def _left_out(results: Results) -> pd.DataFrame:
    """Method, solver, CPU seconds taken and predicted of each run, from all the others."""
    table = results.table.drop_duplicates("record")
    table = table[table["status"] == "done"]
    known = []
    for row, point in table.iterrows():
        config = results.config_at(row)
        work = cost_forecast.work(config, point["steps"], point["particles"])
        known.append(Measurement(point["record"], config, work, point["cpu_seconds"]))
    if len(known) < 2:
        raise Missing(f"{results.name}: fewer than two runs are done")
    rates = Rates(known)
    return table[["method", "solve"]].assign(
        predicted=[rates.seconds(m.config, m.work, without=m.name) for m in known],
        taken=[m.cpu_seconds for m in known],
    )


@figures(
    plate=(
        "work and precision, vibrating plate",
        f"Relative error of the plate's frequency against two-dimensional elasticity. {_HOW}",
        "plate",
        "n_y",
        "error of $\\omega$ against 2-D elasticity (%)",
    ),
    bending=(
        "work and precision, bending plate",
        f"Relative error of the bent plate's strain energy against two-dimensional elasticity. {_HOW}",
        "bending",
        "n_y",
        "error of energy against 2-D elasticity (%)",
    ),
    mode1=(
        "work and precision, crack in mode I",
        f"Relative error of K_I, by an integral about the tip, of one length of the crack. {_HOW}",
        "mode1",
        "n_x",
        "error of $K_\\mathrm{I}$ by integral (%)",
    ),
    mode2=(
        "work and precision, crack in mode II",
        f"Relative error of K_II, by an integral about the tip, of one length of the crack. {_HOW}",
        "mode2",
        "n_x",
        "error of $K_\\mathrm{II}$ by integral (%)",
    ),
)
def _work_precision(results: Results, scene: str, symbol: str, label: str) -> Figure:
    found = points(results.table, scene)
    if found["error"].isna().all():
        raise Missing(f"{results.name}: no point of scene {scene} has {ERRORS[scene]}")
    drawing = Figure(figsize=(TEXT_WIDTH, 4.6), layout="constrained")
    axes = drawing.subplots()
    sizes = sorted(found["n"].unique())
    for kind, rows in found.groupby(["method", "solve"]):
        _draw(axes, rows.dropna(subset=["error"]), sizes, _LOOKS[kind][1])
    _front(axes, front(found))
    axes.set(xscale="log", yscale="log", xlabel="CPU time (s)", ylabel=label)
    failed = _failed(axes, found)
    for axis in (axes.xaxis, axes.yaxis):
        plain_logarithmic(axis)
    axes.set_title(_compilation(found), loc="right", fontsize="small")
    axes.set_title(f"${symbol}$ = {', '.join(map(str, sizes))}", loc="left", fontsize="small")
    kinds = dict.fromkeys(zip(found["method"], found["solve"], strict=True))
    handles = [
        Line2D([], [], linestyle="none", label=_LOOKS[kind][0], **_LOOKS[kind][1])
        for kind in _LOOKS
        if kind in kinds
    ]
    hollow: dict[str, Any] = {"marker": "o", "color": "0.4", "markerfacecolor": "white"}
    handles.append(Line2D([], [], linestyle="none", label="lucky", **hollow))
    handles.append(Line2D([], [], color="black", label="Pareto front, confirmed"))
    handles += [Line2D([], [], linestyle="none", marker="x", color="0.4", label="diverged")] * failed
    drawing.legend(handles=handles, loc="outside upper center", ncols=3)
    return drawing


def _compilation(found: pd.DataFrame) -> str:
    seconds = found["compile_seconds"].max()
    told = f"up to {seconds:.0f} s" if seconds > 0.0 else "none, all compiled before"
    return f"compilation, apart: {told}"


def _draw(axes: Axes, rows: pd.DataFrame, sizes: list[int], look: dict[str, Any]) -> None:
    """Points of one method and solver, joined where they differ in n alone."""
    for number, chosen in rows.groupby("series"):
        chosen = chosen.sort_values("n")
        axes.plot(
            chosen["cpu_seconds"], PERCENT * chosen["size"], color=look["color"], linewidth=0.6, alpha=0.5
        )
        if len(chosen) >= _SEVERAL:
            x, y = chosen["cpu_seconds"].iloc[-1], PERCENT * chosen["size"].iloc[-1]
            # Ends of neighbouring series may lie close together.
            place = (6, -8 if number % 2 else 2)
            style: dict[str, Any] = {"textcoords": "offset points", "fontsize": "x-small"}
            axes.annotate(f"{chosen['h'].iloc[0]:g}", (x, y), place, color=look["color"], **style)
    for (n, lucky), chosen in rows.groupby(["n", "lucky"]):
        fill = (
            {"markerfacecolor": "white"}
            if lucky
            else {"markeredgecolor": "white", "markeredgewidth": 0.5}
        )
        axes.plot(
            chosen["cpu_seconds"],
            PERCENT * chosen["size"],
            linestyle="none",
            markersize=3.0 + 5.0 * sizes.index(n) / max(len(sizes) - 1, 1),
            **look | fill,
        )


def _front(axes: Axes, best: pd.DataFrame) -> None:
    """Steps along the front, and the (n, h) of its points."""
    cost, error = best["cpu_seconds"].to_numpy(), PERCENT * best["assured"].to_numpy()
    axes.step(cost, error, where="post", color="black", linewidth=1.2, zorder=4)
    last = np.inf
    for x, y, n, h in zip(cost, error, best["n"], best["h"], strict=True):
        # Names of points at nearly the same height would cover each other.
        if y < _LOWER * last:
            offset: dict[str, Any] = {"textcoords": "offset points", "fontsize": "x-small", "zorder": 5}
            axes.annotate(f"({n}, {h:g})", (x, y), (-4, -4), ha="right", va="top", **offset)
            last = y


def _failed(axes: Axes, found: pd.DataFrame) -> bool:
    """Crosses along the upper edge where runs diverged, and whether any did."""
    failed = found[found["status"] == "diverged"]
    low, high = axes.get_ylim()
    edge = high * (high / low) ** 0.06
    for kind, rows in failed.groupby(["method", "solve"]):
        axes.plot(
            rows["cpu_seconds"],
            np.full(len(rows), edge),
            linestyle="none",
            marker="x",
            color=_LOOKS[kind][1]["color"],
        )
    axes.set_ylim(low, edge * (high / low) ** 0.04 if len(failed) else high)
    return not failed.empty
