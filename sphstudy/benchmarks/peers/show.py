"""Table and figure of the peers' dataset."""

from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sphstudy import console
from sphstudy.benchmarks.figures import write_figure
from sphstudy.benchmarks.peers.dataset import STATUS
from sphstudy.benchmarks.tables import table
from sphstudy.report.drawing import TEXT_WIDTH, plain_logarithmic
from sphstudy.report.series import PERCENT

_COLUMNS = (
    "code",
    "n",
    "setting",
    "status",
    "frequency_error_2d",
    "cpu_seconds",
    "repeats",
    "steps",
    "particles",
    "time_step",
    "courant",
    "limit_share",
)


def print_table(found: xr.Dataset) -> None:
    """Prints a line for each point of the dataset, then releases and settings of each code."""
    shown = found.assign(
        status=("point", [STATUS[status] for status in found["status"].values]),
        repeats=found["cpu_seconds_repeat"].notnull().sum("repeat"),
    )
    console.print_table(table("", shown, "point", _COLUMNS))
    for code in dict.fromkeys(found["code"].values):
        points = found.isel(point=np.flatnonzero(found["code"].values == code))
        print(f"{code}: {points['versions'].values[0]}")
        print(f"    {points['settings'].values[0]}")
        for message in dict.fromkeys(filter(None, points["message"].values)):
            print(f"    {message}")
    print(f"{found.attrs['processor']}, {found.attrs['date_created']}")


def figure(found: xr.Dataset) -> Figure:
    """Size of the error over CPU seconds: a marker a code, larger with n; hollow at the usual setting."""
    drawing = Figure(figsize=(TEXT_WIDTH, 4.0), layout="constrained")
    axes = drawing.subplots()
    done = found.isel(point=np.flatnonzero(found["status"].values == STATUS.index("done")))
    sizes = sorted(set(done["n"].values))
    handles = []
    for i, (code, marker) in enumerate(
        zip(dict.fromkeys(done["code"].values), cycle("os^Dv*P"), strict=False)
    ):
        points = done.isel(point=np.flatnonzero(done["code"].values == code))
        look: dict[str, Any] = {"linestyle": "none", "marker": marker, "color": f"C{i % 7}"}
        for n, setting, seconds, error in zip(
            *(points[name].values for name in ("n", "setting", "cpu_seconds", "frequency_error_2d")),
            strict=True,
        ):
            hollow = {"markerfacecolor": "none"} if setting == "usual" else {}
            axes.loglog(
                seconds, PERCENT * abs(error), markersize=5 + 2 * sizes.index(n), **look, **hollow
            )
        handles.append(Line2D([], [], label=points["title"].values[0], **look))
    axes.margins(0.08)
    for axis in (axes.xaxis, axes.yaxis):
        plain_logarithmic(axis)
    axes.set_xlabel("CPU time (s)")
    axes.set_ylabel("error of $\\omega$ against 2-D elasticity (%)")
    which = ", ".join(str(n) for n in sizes)
    axes.set_title(
        f"$n_y$ = {which}, larger markers for more; hollow: usual time step, filled: 0.9 of its limit"
    )
    drawing.legend(handles=handles, loc="outside upper center", ncols=2)
    return drawing


def draw(found: xr.Dataset, folder: Path) -> Path:
    """Writes the figure as PNG, whose path is returned, and PDF."""
    return write_figure(figure, found, folder / "peers.png")
