"""Figures of `sphstudy speed`: time per pair over the number of particles, and what each term costs."""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sphstudy.benchmarks.figures import write_figure
from sphstudy.benchmarks.speed.terms import Time, term_costs
from sphstudy.report.drawing import TEXT_WIDTH, plain_logarithmic
from sphstudy.report.series import legend_above

_MARKERS = {"lattice": "o", "perturbed": "s", "shuffled": "^"}
_COLOURS = {"thesis": "C0", "tl": "C1"}
_ARRANGEMENTS = {
    "lattice": "lattice",
    "perturbed": "perturbed",
    "shuffled": "perturbed, in random order",
}


def write_figures(found: xr.Dataset, folder: Path) -> list[Path]:
    """Draws the figures that the dataset has numbers for; returns the PNG files, beside PDFs."""
    measured = found["rate_group"].values if "rate" in found.dims else ()
    return [
        write_figure(draw, found, folder / f"{draw.__name__}.png")
        for draw in (growth, terms)
        if draw.__name__ in measured
    ]


def growth(found: xr.Dataset) -> Figure:
    """CPU time per unordered pair and evaluation over the number of particles, a curve for each form.

    Bars reach from the fastest to the slowest round. `found`: as `dataset.dataset` makes it.
    """
    chosen = found.isel(rate=np.flatnonzero(found["rate_group"].values == "growth"))
    drawing = Figure(figsize=(5.6, 4.4), layout="constrained")
    axes = drawing.subplots()
    method, arrangement = chosen["rate_method"].values, chosen["rate_arrangement"].values
    for one, kind in dict.fromkeys(zip(method, arrangement, strict=True)):
        form = chosen.isel(rate=np.flatnonzero((method == one) & (arrangement == kind)))
        time = form["pair_time"].values
        rounds = form["step_times"].values / form["step_time"].values[:, None] * time[:, None]
        low, high = np.nanmin(rounds, axis=1), np.nanmax(rounds, axis=1)
        axes.errorbar(
            form["particles"].values,
            time,
            yerr=(time - low, high - time),
            marker=_MARKERS[str(kind)],
            color=_COLOURS[str(one)],
            linestyle="-" if kind == "lattice" else "--" if kind == "perturbed" else ":",
            label=f"{one}, {_ARRANGEMENTS[str(kind)]}",
        )
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="particles",
        ylabel="CPU time per unordered pair\nand evaluation (ns)",
    )
    plain_logarithmic(axes.yaxis)
    legend_above(drawing, axes, columns=2)
    return drawing


def terms(found: xr.Dataset) -> Figure:
    """Time of a step per pair with each term switched off, and with a method that never had it.

    Bars join the quartiles of the rounds; the line is the method with all terms. `found`: as above.
    """
    costs = term_costs(found)
    methods = list(dict.fromkeys(one.method for one in costs))
    counts = [sum(one.method == method for one in costs) for method in methods]
    drawing = Figure(figsize=(TEXT_WIDTH, 1.6 + 0.3 * sum(counts)), layout="constrained")
    panels = drawing.subplots(len(methods), 1, squeeze=False, height_ratios=counts)[:, 0]
    for axes, method in zip(panels, methods, strict=True):
        chosen = [one for one in costs if one.method == method]
        full = chosen[0].full.median
        axes.axvline(full, color="0.3", linestyle="--", label="all terms")
        _times(axes, [one.never for one in chosen], -0.15, "o", "never there")
        _times(axes, [one.off for one in chosen], 0.15, "s", "switched off")
        axes.set_yticks(range(len(chosen)), [one.term for one in chosen])
        axes.set(title=method, ylim=(len(chosen) - 0.5, -0.5))
        axes.set_xlim(left=0.0)
    panels[-1].set_xlabel("CPU time per unordered pair and evaluation (ns)")
    legend_above(drawing, panels[0], columns=3)
    return drawing


def _times(axes: Axes, times: list[Time], aside: float, marker: str, label: str) -> None:
    """Medians with quartiles, a row for each term, moved aside by this part of a row."""
    median, lower, upper = np.array(times).T
    rows = np.arange(len(times)) + aside
    axes.errorbar(median, rows, xerr=(median - lower, upper - median), fmt=marker, label=label)
