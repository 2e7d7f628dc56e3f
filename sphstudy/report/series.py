"""Curves of a metric over h, one for each n: in all figures the coarsest n looks the same, and so on."""

from itertools import cycle
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results

PERCENT = 100.0
"""Factor from a relative number to percent."""

RADIUS = "relative smoothing radius $\\tilde{h}$"
"""The label of an axis over h."""

MARKERS = "os^Dv"
"""Of the first, second … curve of a figure."""


def curves(axes: Axes, grid: pd.DataFrame, symbol: str) -> None:
    """Draws a curve for each column n of a grid (Results.grid) over its index h; NaN leaves a gap.

    Parameters
    ----------
    axes : Axes
        Where. They show zero if that costs less than half of their height.
    grid : pandas.DataFrame
        Values over h (index) and n (columns).
    symbol : str
        What the legend calls n.
    """
    for marker, (n, column) in zip(cycle(MARKERS), grid.items(), strict=False):
        axes.plot(grid.index, column, marker=marker, label=f"${symbol} = {n}$")
    axes.set_xticks(grid.index)
    lowest, highest = grid.min(axis=None), grid.max(axis=None)
    if min(abs(lowest), abs(highest)) < highest - lowest or lowest < 0.0 < highest:
        zero_line(axes)


def zero_line(axes: Axes) -> None:
    """Draws a thin level line at zero, behind the data."""
    axes.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)


def ring_unstable(axes: Axes, results: Results, grid: pd.DataFrame) -> None:
    """Draws rings around the values of a grid (see `curves`) in cells that the study calls unstable."""
    rings = [
        (h, value)
        for n, column in grid.items()
        for h, value in column.dropna().items()
        for flat in (results.config({"h": h, "n": n}, block="grid").flat(),)
        if any(cell.holds(flat) for cell in results.definition.unstable)
    ]
    if rings:
        h, values = zip(*rings, strict=True)
        look: dict[str, Any] = {"markersize": 12, "markeredgecolor": "0.3", "markerfacecolor": "none"}
        axes.plot(h, values, "o", **look, label="unstable cell", zorder=1)


def legend_above(figure: Figure, axes: Axes, columns: int) -> None:
    """Puts the legend of these axes above all axes of the figure, where it covers no data."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=columns)
