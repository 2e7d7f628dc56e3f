"""The stability map: which method gets through which hard case."""

import textwrap
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from sphstudy.analysis.results import Missing, Results
from sphstudy.analysis.stability.cases import Case, by_place, judged
from sphstudy.analysis.stability.judge import DEGRADED, DIVERGED, DONE, Judgement
from sphstudy.report.drawing import TEXT_WIDTH
from sphstudy.report.figure import figure
from sphstudy.text import number

_LOOKS: dict[str, tuple[str, str, str]] = {
    DONE: ("#e3f1fa", "black", "\N{CHECK MARK}"),
    DEGRADED: ("#f0b03f", "black", "\N{BLACK UP-POINTING TRIANGLE}"),
    DIVERGED: ("#8c2d04", "white", "\N{MULTIPLICATION X}"),
}
"""For each outcome: colour of a cell, of its text, and its sign. Darker is worse, in grey as well."""

_OTHER = ("white", "black", "?")
"""Runs without a result: failed, timed out, not there. Hatched."""

_HATCH: dict[str, Any] = {"hatch": "////", "edgecolor": "0.8"}

_SHORT = {
    "energy_gain": "energy",
    "energy_error": "energy",
    "momentum_drift": "momentum",
    "angular_momentum_drift": "ang. mom.",
    "smallest_spacing": "spacing",
    "speed": "speed",
    "hourglass_share": "checkerb.",
    "hourglass_amplitude": "checkerb.",
    "mirror_defect": "mirror",
}

_LETTERS = 17.0
"""Characters of a cell's second line that fit into one inch."""


@figure(
    "stability map",
    "What becomes of each run: done, inside all of its bounds; degraded, outside one of them while all "
    "numbers stay finite; diverged. In a cell: when it was first outside (s), and by which indicator or "
    "metric, whose time is the end of the run. The bounds and their reasons stand in a table.",
)
def map(results: Results) -> Figure:
    cases = judged(results)
    if all(case.judgement.outcome == "missing" for case in cases):
        raise Missing(f"{results.name}: no run is stored")
    return matrix(cases)


def matrix(cases: list[Case]) -> Figure:
    """The map of these runs: a row for each case, a column for each method and h."""
    grid = by_place(cases)
    rows, columns = grid.shape
    names = max(len(label) for label in grid.index)
    left = min(2.6, 0.3 + 0.068 * names)
    width = max(TEXT_WIDTH, left + 0.62 * columns)
    letters = int(_LETTERS * (width - left) / columns)
    drawing = Figure(figsize=(width, 0.32 * rows + 1.7), layout="constrained")
    axes = drawing.subplots()
    for row, column in np.argwhere(grid.to_numpy() >= 0):
        _cell(axes, column, row, cases[grid.iat[row, column]].judgement, letters)
    _frame(axes, grid, letters)
    seen = {case.judgement.outcome for case in cases}
    handles = [
        Patch(facecolor=colour, edgecolor="0.5", label=f"{sign} {outcome}")
        for outcome, (colour, _, sign) in _LOOKS.items()
    ]
    if seen - set(_LOOKS):
        handles.append(Patch(facecolor=_OTHER[0], label=f"{_OTHER[2]} no result", **_HATCH))
    drawing.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return drawing


def _cell(axes: Axes, column: int, row: int, found: Judgement, letters: int) -> None:
    colour, ink, sign = _LOOKS.get(found.outcome, _OTHER)
    edges = {"edgecolor": "white"} if found.outcome in _LOOKS else _HATCH
    axes.add_patch(Rectangle((column, row), 1.0, 1.0, facecolor=colour, linewidth=1.0, **edges))
    middle: dict[str, Any] = {"ha": "center", "va": "center", "color": ink}
    if found.outcome == DONE:
        axes.text(column + 0.5, row + 0.5, sign, fontsize=9, **middle)
        return
    when = "" if np.isnan(found.time) else f" {number(found.time, 2)}"
    axes.text(column + 0.5, row + 0.3, f"{sign}{when}", fontsize=6.5, **middle)
    axes.text(column + 0.5, row + 0.72, _indicator(found, letters), fontsize=5.5, **middle)


def _indicator(found: Judgement, letters: int) -> str:
    if not found.breaches:
        return "" if found.outcome == DIVERGED else found.outcome
    bound = found.breaches[0].bound
    if bound.indicator:
        return _SHORT[bound.indicator]
    words = bound.quantity.replace("_", " ")
    return words if len(words) <= letters else words[: letters - 1] + "…"


def _wrapped(variant: str, width: int) -> str:
    """A setting and its value stay on a line if they fit there."""
    parts = (
        part.replace(" ", "\N{NO-BREAK SPACE}") if len(part) <= width else part
        for part in variant.split(", ")
    )
    return textwrap.fill(", ".join(parts), width)


def _frame(axes: Axes, grid: pd.DataFrame, letters: int) -> None:
    """Cases on the left, h below, above it the method over all of its h."""
    rows, columns = grid.shape
    axes.set(xlim=(0, columns), ylim=(rows, 0))
    axes.set_yticks(np.arange(rows) + 0.5, grid.index, fontsize=7.5)
    places = list(grid.columns)
    axes.set_xticks(np.arange(columns) + 0.5, [f"{h:g}" for _, h in places], fontsize=7.5)
    axes.set_xlabel("relative smoothing radius $\\tilde{h}$", fontsize=8)
    axes.tick_params(length=0)
    axes.grid(False)
    for side in axes.spines.values():
        side.set_visible(False)
    for variant in dict.fromkeys(variant for variant, _ in places):
        those = [k for k, (other, _) in enumerate(places) if other == variant]
        label = _wrapped(variant, letters * len(those))
        axes.text(those[0] + 0.06, -0.15, label, ha="left", va="bottom", fontsize=7.5, linespacing=1.05)
        if those[0]:
            axes.axvline(those[0], color="0.4", linewidth=0.8)
    scenes = [label.partition(",")[0] for label in grid.index]
    for row in range(1, rows):
        if scenes[row] != scenes[row - 1]:
            axes.axhline(row, color="0.4", linewidth=0.8)
