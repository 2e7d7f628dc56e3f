"""Particles of several runs of one scene beside each other: same scales, same view, state by state."""

import textwrap
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from sphstudy.analysis.stability.judge import DONE
from sphstudy.metrics.von_mises import von_mises
from sphstudy.numerics.solvers.solution import LAST_GOOD
from sphstudy.report.drawing import TEXT_WIDTH
from sphstudy.store.record import configuration
from sphstudy.text import number

_STRESSES = ("stress_xx", "stress_yy", "stress_xy")
_UNITS = ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa"))

_SLENDER = 2.2
"""Bodies that are so many times as long as high are drawn below each other, if they are few."""

_ACROSS = 3
"""Panels beside each other at most."""

_WIDE = 9.0
"""Width (inch) of a figure with so many."""

_LETTERS = 14
"""Of a title in an inch."""

_SHARE = 99.5
"""Percentile of the colours' end: a few particles must not take all the colours."""

Quantity = Callable[[xr.Dataset, xr.Dataset], np.ndarray]
"""Of a record and one or more of its states, what colours its particles."""


def mises(run: xr.Dataset, state: xr.Dataset) -> np.ndarray:
    """Von Mises stress (Pa)."""
    scene = configuration(run).scene
    xx, yy, xy = (state[name].values for name in _STRESSES)
    return von_mises(xx, yy, xy, scene.plane, scene.nu)


def pressure(run: xr.Dataset, state: xr.Dataset) -> np.ndarray:
    """Less a third of the trace of the stress (Pa); plane strain: σzz = ν (σxx + σyy)."""
    scene = configuration(run).scene
    in_plane = state["stress_xx"].values + state["stress_yy"].values
    return -in_plane * (1.0 + (scene.nu if scene.plane == "strain" else 0.0)) / 3.0


@dataclass(frozen=True)
class Shown:
    """A run as it is shown: its record, the case that it is of, what it is called, and its outcome."""

    run: xr.Dataset
    case: str
    label: str
    outcome: str

    @property
    def times(self) -> np.ndarray:
        """Of the states that were kept (s); of a diverged run the last one is the last good one."""
        return self.run["snapshot_time"].values


class Panels:
    """A figure with a panel for each of some runs of a scene, coloured by one quantity.

    View and colours are those of the sound runs, if there are any: what flies apart leaves the picture,
    what is beyond the colours has the last of them.
    """

    def __init__(self, shown: list[Shown], quantity: Quantity, label: str, symmetric: bool = False):
        """label: of the quantity, without unit. symmetric: colours about zero."""
        self.shown, self._quantity = shown, quantity
        sound = next(
            filter(None, ([s for s in shown if s.outcome == o] for o in (DONE, "degraded"))), shown
        )
        view = _view([s.run for s in sound])
        slender = view[1] - view[0] > _SLENDER * (view[3] - view[2])
        columns, places = _arranged(shown, slender)
        rows = max(places) // columns + 1
        total = TEXT_WIDTH if columns < _ACROSS else _WIDE
        self._letters = int(_LETTERS * total / columns)
        width = total / columns
        height = width * (view[3] - view[2]) / (view[1] - view[0]) + 0.5
        self.figure = Figure(figsize=(total, rows * height + 0.75), layout="constrained")
        # A list: an array of axes would be copied apart from the figure on its way to another process.
        axes = list(self.figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).flat)
        limits, scale, unit = self._colours(sound, symmetric)
        self._scale = scale
        self.axes = [axes[place] for place in places]
        self._bodies = [
            self._body(panel, one, view, limits, symmetric)
            for panel, one in zip(self.axes, shown, strict=True)
        ]
        for place in set(range(len(axes))) - set(places):
            axes[place].set_axis_off()
        self.figure.colorbar(
            self._bodies[0],
            ax=axes,
            label=f"{label} ({unit})",
            extend="both" if symmetric else "max",
            location="top",
            aspect=50,
            shrink=0.8,
            pad=0.02,
        )
        self.figure.supxlabel("$x$ (m)", fontsize="medium")
        self.figure.supylabel("$y$ (m)", fontsize="medium")

    def show(self, time: float) -> None:
        """Shows of each run the last state until then (s), which is also said."""
        for body, axes, one in zip(self._bodies, self.axes, self.shown, strict=True):
            # Times of states are those of steps, which are not the same in all runs.
            k = max(0, int((one.times <= time + 0.5 * self._interval).sum()) - 1)
            state = one.run.isel(snapshot=k)
            body.set_offsets(np.column_stack((state["x"].values, state["y"].values)))
            body.set_array(self._quantity(one.run, state) / self._scale)
            over = one.outcome != DONE and one.outcome != "degraded" and k == one.times.size - 1
            last = str(state["snapshot_label"].values) == LAST_GOOD
            # Plain text: formulas take a third of the time of a frame.
            when = f"t = {number(float(one.times[k]), 3)} s"
            said = f"{one.outcome}, last good state, {when}" if last or over else when
            axes.set_title(f"{textwrap.fill(one.label, self._letters)}\n{said}", fontsize="small")

    @property
    def end(self) -> float:
        """Time of the last state of any run (s)."""
        return max(one.times.max() for one in self.shown)

    @property
    def frames(self) -> int:
        """The most states that any run has kept."""
        return max(one.times.size for one in self.shown)

    @property
    def _interval(self) -> float:
        return self.end / max(1, self.frames - 1)

    def _colours(self, sound: list[Shown], symmetric: bool) -> tuple[tuple[float, float], float, str]:
        values = [np.abs(self._quantity(one.run, one.run)) for one in sound]
        most = max((float(np.nanpercentile(v, _SHARE)) for v in values), default=1.0) or 1.0
        scale, unit = next(one for one in _UNITS if most >= one[0] or one is _UNITS[-1])
        return (-most / scale if symmetric else 0.0, most / scale), scale, unit

    def _body(
        self, axes: Axes, one: Shown, view: tuple, limits: tuple[float, float], symmetric: bool
    ) -> EllipseCollection:
        count = one.run.sizes["particle"]
        width, height = (np.full(count, float(one.run[f"spacing_{axis}"])) for axis in "xy")
        body = EllipseCollection(
            width,
            height,
            np.zeros(count),
            units="xy",
            offsets=np.zeros((count, 2)),
            offset_transform=axes.transData,
            cmap="RdBu_r" if symmetric else "cividis",
            # White in the middle of the colours would be lost on the page.
            linewidth=0.3 if symmetric else 0.0,
            edgecolor="0.6",
            rasterized=True,
        )
        body.set_clim(*limits)
        axes.add_collection(body, autolim=False)
        axes.set(xlim=view[:2], ylim=view[2:], aspect="equal")
        axes.locator_params(nbins=4)
        axes.label_outer()
        axes.grid(False)
        return body


def _arranged(shown: list[Shown], slender: bool) -> tuple[int, list[int]]:
    """Columns of panels, and the place of each run: cases below each other if that leaves room."""
    cases = [one.case for one in shown]
    several = list(dict.fromkeys(cases))
    widest = max(cases.count(case) for case in several)
    if len(several) > 1 and widest <= _ACROSS:
        rows = [several.index(case) for case in cases]
        return widest, [row * widest + rows[:k].count(row) for k, row in enumerate(rows)]
    few, across = (3, 2) if slender else (1, 2 if len(shown) in (2, 4) else _ACROSS)
    return (1 if len(shown) <= few else across), list(range(len(shown)))


def _view(runs: list[xr.Dataset]) -> tuple[float, float, float, float]:
    """Left, right, bottom and top of all states of these runs, with a margin (m)."""
    edges = []
    for axis in "xy":
        low = min(float(run[axis].min()) for run in runs)
        high = max(float(run[axis].max()) for run in runs)
        edges.append((low, high))
    margin = 0.02 * max(high - low for low, high in edges) + max(float(r["spacing_x"]) for r in runs)
    (left, right), (bottom, top) = edges
    return left - margin, right + margin, bottom - margin, top + margin
