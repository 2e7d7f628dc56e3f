"""Speed on one machine: time per pair over the number of particles, and what each term costs."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from sphstudy.report.drawing import TEXT_WIDTH, plain_logarithmic
from sphstudy.report.series import legend_above
from sphstudy.speed.tables import term_costs

_MARKERS = {"lattice": "o", "perturbed": "s", "shuffled": "^"}
_COLOURS = {"thesis": "C0", "tl": "C1"}
_ARRANGEMENTS = {
    "lattice": "lattice",
    "perturbed": "perturbed",
    "shuffled": "perturbed, in random order",
}


def growth(found: xr.Dataset) -> Figure:
    """CPU time per unordered pair and evaluation over the number of particles, a curve for each form.

    Bars from the fastest to the slowest round. `found`: dataset of speed.dataset.
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
        ylabel="CPU time per unordered pair and evaluation (ns)",
    )
    plain_logarithmic(axes.yaxis)
    legend_above(drawing, axes, columns=2)
    return drawing


def terms(found: xr.Dataset) -> Figure:
    """Time of a step per pair with each term switched off, and with a method that never had it.

    The line: with all terms. `found`: dataset of speed.dataset.
    """
    costs = term_costs(found)
    methods = list(dict.fromkeys(row[0] for row in costs))
    counts = [sum(row[0] == method for row in costs) for method in methods]
    drawing = Figure(figsize=(TEXT_WIDTH, 1.6 + 0.3 * sum(counts)), layout="constrained")
    panels = drawing.subplots(len(methods), 1, squeeze=False, height_ratios=counts)[:, 0]
    for axes, method in zip(panels, methods, strict=True):
        _, names, full, off, never = zip(*(row for row in costs if row[0] == method), strict=True)
        places = np.arange(len(names))
        axes.axvline(full[0], color="0.3", linestyle="--", label="all terms")
        axes.hlines(places, never, full, color="0.75", linewidth=4.0, zorder=1)
        axes.plot(never, places, "o", markersize=9, markerfacecolor="none", label="never there")
        axes.plot(off, places, "x", color="C1", label="switched off")
        axes.set_yticks(places, names)
        axes.invert_yaxis()
        axes.set(title=method, xlim=(0.0, 1.05 * max(*full, *off, *never)), ylim=(len(names) - 0.5, -0.5))
    panels[-1].set_xlabel("CPU time per unordered pair and evaluation (ns)")
    legend_above(drawing, panels[0], columns=3)
    return drawing
