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
"""Length over height from which on few bodies are drawn below each other."""

_ACROSS = 3
"""Most panels beside each other."""

_WIDE = 9.0
"""Width (inch) of a figure with that many."""

_LETTERS = 14
"""Characters of a panel title that fit into one inch."""

_SHARE = 99.5
"""Percentile at which the colours end: a few particles must not take all of them."""

Quantity = Callable[[xr.Dataset, xr.Dataset], np.ndarray]
"""What colours the particles: from a record, and one or more of its states, values [..., N]."""


def mises(run: xr.Dataset, state: xr.Dataset) -> np.ndarray:
    """Von Mises stress (Pa)."""
    scene = configuration(run).scene
    xx, yy, xy = (state[name].values for name in _STRESSES)
    return von_mises(xx, yy, xy, scene.plane, scene.nu)


def pressure(run: xr.Dataset, state: xr.Dataset) -> np.ndarray:
    """Pressure (Pa), -tr(σ)/3; in plane strain σzz = ν (σxx + σyy)."""
    scene = configuration(run).scene
    in_plane = state["stress_xx"].values + state["stress_yy"].values
    return -in_plane * (1.0 + (scene.nu if scene.plane == "strain" else 0.0)) / 3.0


@dataclass(frozen=True)
class Shown:
    """A run on a panel: its record, its case (runs of one case share a row), title and outcome."""

    run: xr.Dataset
    case: str
    label: str
    outcome: str

    @property
    def times(self) -> np.ndarray:
        """Times (s) of the stored states; a diverged run ends with its last good one."""
        return self.run["snapshot_time"].values


class Panels:
    """A figure with a panel for each run, its particles coloured by one quantity.

    The sound runs, if there are any, determine view and colours: particles that fly apart leave the
    picture, values beyond the colours have the last of them.

    Parameters
    ----------
    shown : list of Shown
        Runs of one scene.
    quantity : Quantity
        What colours their particles (Pa).
    label : str
        The name of the quantity, without unit.
    symmetric : bool
        Whether the colours lie about zero.
    """

    def __init__(self, shown: list[Shown], quantity: Quantity, label: str, symmetric: bool = False):
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
        # A list: pickling an array of axes would copy them apart from their figure.
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
        """Shows the last state of each run up to that time (s), and writes its time in the title."""
        for body, axes, one in zip(self._bodies, self.axes, self.shown, strict=True):
            # States lie at steps, and steps differ from run to run.
            k = max(0, int((one.times <= time + 0.5 * self._interval).sum()) - 1)
            state = one.run.isel(snapshot=k)
            body.set_offsets(np.column_stack((state["x"].values, state["y"].values)))
            body.set_array(self._quantity(one.run, state) / self._scale)
            over = one.outcome != DONE and one.outcome != "degraded" and k == one.times.size - 1
            last = str(state["snapshot_label"].values) == LAST_GOOD
            # Plain text: a formula would take a third of a frame's time.
            when = f"t = {number(float(one.times[k]), 3)} s"
            said = f"{one.outcome}, last good state, {when}" if last or over else when
            axes.set_title(f"{textwrap.fill(one.label, self._letters)}\n{said}", fontsize="small")

    @property
    def end(self) -> float:
        """Time of the last state of any run (s)."""
        return max(one.times.max() for one in self.shown)

    @property
    def frames(self) -> int:
        """The number of states of the run that has most."""
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
