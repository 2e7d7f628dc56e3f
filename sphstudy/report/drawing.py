"""Shared parts of figures: how particles look, and the scene that a schematic figure shows."""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator
from numpy.typing import ArrayLike

from sphstudy.analysis.results import Missing, Results
from sphstudy.catalogue import scene_module
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.model.problem import Problem

TEXT_WIDTH = 6.7
"""Width (inch) of a figure as wide as a text column of 17 cm."""

# Shapes differ as well as colours, so that nothing is lost in black and white.
MARKS: dict[str, dict[str, Any]] = {
    "free": {"marker": "o", "markerfacecolor": "white", "markeredgecolor": "0.5"},
    "fixed": {"marker": "s", "color": "C6"},
    "prescribed": {"marker": "^", "color": "C1"},
    "tracked": {"marker": "*", "color": "C0"},
    "marked": {"marker": "o", "color": "C0"},
    "observer": {"marker": "o", "color": "C0", "markersize": 8},
    "neighbour": {"marker": "s", "color": "C2"},
    "hidden": {"marker": "*", "color": "C6", "markersize": 9},
    "reference": {"marker": "o", "color": "0.75", "markersize": 3},
}
"""The look of particles by kind. observer: particle i; neighbour: one that it interacts with; hidden: one
behind a crack; reference: one in the background."""


def particles(
    axes: Axes, x: ArrayLike, y: ArrayLike, kind: str, label: str = "", **line_options: Any
) -> Line2D:
    """Marks particles.

    Parameters
    ----------
    axes : Axes
        Where.
    x, y : array [M]
        Positions.
    kind : str
        Key of MARKS; their label in the legend if `label` is empty.
    """
    options = {"linestyle": "none", "label": label or kind, **MARKS[kind], **line_options}
    return axes.plot(x, y, **options)[0]


def footprints(
    axes: Axes,
    x: ArrayLike,
    y: ArrayLike,
    width: float,
    height: float,
    values: ArrayLike | None = None,
    **collection_options: Any,
) -> PolyCollection:
    """Draws each particle as the rectangle that it stands for, and zooms to what is drawn.

    Parameters
    ----------
    axes : Axes
        Where. A later call widens what they show.
    x, y : array [N]
        Middles (m).
    width, height : float
        Of a rectangle (m), Δx and Δy.
    values : array [N], optional
        What colours them; NaN leaves a rectangle out.
    **collection_options
        Of PolyCollection: `cmap`, `norm`, `clim`; `facecolor` for one colour.
    """
    corners = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]) * (width, height)
    centres = np.column_stack((np.ravel(x), np.ravel(y)))
    # Edges in the colour of the fill close the hairlines between rectangles that do not quite meet.
    options: dict[str, Any] = {"linewidth": 0.2, "edgecolor": "face", "rasterized": True}
    collection = PolyCollection(list(centres[:, None, :] + corners), **(options | collection_options))
    if values is not None:
        collection.set_array(np.ravel(values))
    axes.add_collection(collection, autolim=True)
    axes.autoscale_view()
    return collection


def spacing(run: xr.Dataset) -> tuple[float, float]:
    """Δx and Δy (m) of a record."""
    return float(run["spacing_x"]), float(run["spacing_y"])


def plain_logarithmic(axis: Axis) -> None:
    """Labels a logarithmic axis with plain numbers: 1, 2, 5, 10 …, a long one with fewer."""
    low, high = axis.get_view_interval()
    subdivisions = {30.0: (1.0, 2.0, 5.0), 1000.0: (1.0, 3.0), np.inf: (1.0,)}
    axis.set_major_locator(
        LogLocator(subs=next(subs for most, subs in subdivisions.items() if high < most * low))
    )
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter("{x:g}")


def geometry(axes: Axes) -> None:
    """Prepares axes for a drawing of the body: equal scales, no grid, coordinates in metres."""
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")


def first_configuration(results: Results, scene: str) -> RunConfig:
    """Configuration of the scene's first point in block `grid`; raises Missing if there is none."""
    rows = results.select({"scene": scene}, "grid")
    if rows.empty:
        raise Missing(f"{results.name}: no point of scene {scene} in block grid")
    settings = {"scene": scene, "h": rows["h"].iloc[0], "n": rows["n"].iloc[0]}
    return results.config(settings, "grid")


def built(config: RunConfig, n: int | None = None) -> Problem:
    """The problem of a configuration, with resolution n if it is given."""
    config = config if n is None else replace(config, n=n)
    return scene_module(config.scene.kind).build(config)
