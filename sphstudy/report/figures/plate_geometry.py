"""The plate: its geometry, its particles, and how its end is bent (thesis 3.1 and 3.2)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

from sphstudy.analysis.results import Results
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.metrics.bending import column_angle
from sphstudy.model.exact import beam
from sphstudy.model.problem import Problem
from sphstudy.report.drawing import (
    TEXT_WIDTH,
    built,
    first_configuration,
    footprints,
    geometry,
    particles,
)
from sphstudy.report.figure import figure

_EXAGGERATION = 4
_COARSE = 9
"""Rows of a plate whose particles are drawn, at most."""


@figure(
    "3.1",
    "Geometry of the plate, clamped at x = 0, and the lowest mode of the beam at the height of its "
    f"motion, {_EXAGGERATION} times as large as it is (dashed).",
)
def geometry_of_plate(results: Results) -> Figure:
    """The plate true to scale, its dimensions, and the mode shape with which it is set in motion."""
    scene = first_configuration(results, "plate").scene
    length, height = scene.L, scene.L / scene.slenderness

    drawing = Figure(figsize=(TEXT_WIDTH, 1.8), layout="constrained")
    axes = drawing.add_subplot()
    plate = Rectangle((0.0, -0.5 * height), length, height, facecolor="0.88", edgecolor="C6")
    axes.add_patch(plate)
    _wall(axes, height)
    x = np.linspace(0.0, length, 200)
    raised = beam.mode_shape(x, length) * scene.H0 * length * _EXAGGERATION
    outline_x = np.concatenate((x, x[::-1]))
    outline_y = np.concatenate((raised - 0.5 * height, raised[::-1] + 0.5 * height))
    axes.plot(outline_x, outline_y, "--", color="C0", linewidth=1.0)
    axes.plot(x, raised, "-.", color="C0", linewidth=0.8)
    axes.plot([0.0, length], [0.0, 0.0], "-.", color="0.5", linewidth=0.8)

    _dimension(axes, (0.0, -0.75 * height), (length, -0.75 * height), f"L = {length:g} m")
    inside = 0.08 * length
    _dimension(axes, (inside, -0.5 * height), (inside, 0.5 * height), f"D = {height:.3g} m")
    tip = 1.03 * length
    text = f"{_EXAGGERATION} H$_0$ = {_EXAGGERATION} × {scene.H0 * length:g} m"
    _dimension(axes, (tip, 0.0), (tip, raised[-1]), text)
    geometry(axes)
    axes.set_xlim(-0.07 * length, 1.36 * length)
    axes.set_ylim(-1.4 * height, 1.7 * height)
    return drawing


def _coarse(results: Results, scene: str) -> tuple[RunConfig, Problem, float, float]:
    """Configuration and particles of a plate of few rows, its length and height (m)."""
    config = first_configuration(results, scene)
    height = config.scene.L / config.scene.slenderness
    return config, built(config, min(config.n, _COARSE)), config.scene.L, height


def _wall(axes: Axes, height: float) -> None:
    """The wall to which a plate of that height (m) is clamped."""
    wall = Rectangle((-0.5 * height, -height), 0.5 * height, 2.0 * height, hatch="////")
    wall.set(facecolor="white", edgecolor="0.4", linewidth=0.0)
    axes.add_patch(wall)
    axes.plot([0.0, 0.0], [-height, height], color="0.3", linewidth=1.2)


def _dimension(axes: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension line with its text: under a level line, to the right of an upright one."""
    axes.annotate("", start, end, arrowprops={"arrowstyle": "<->", "shrinkA": 0, "shrinkB": 0})
    middle = (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]))
    level = start[1] == end[1]
    offset, place = ((0, -3), ("center", "top")) if level else ((4, 0), ("left", "center"))
    blank = {"facecolor": axes.get_facecolor(), "edgecolor": "none", "pad": 0.5}
    axes.annotate(text, middle, offset, textcoords="offset points", ha=place[0], va=place[1], bbox=blank)


@figure(
    "3.2",
    "The plate as particles: whole, and its two ends with the rectangle Δx by Δy that each particle "
    "stands for. The tracked particle is the one whose displacement is recorded.",
)
def particles_of_plate(results: Results) -> Figure:
    """Particles of the vibrating plate, no finer than nine rows, by kind."""
    _, problem, length, height = _coarse(results, "plate")
    body = problem.body

    drawing = Figure(figsize=(TEXT_WIDTH, 4.6), layout="constrained")
    panels = drawing.subplot_mosaic([["whole", "whole"], ["wall", "end"]], height_ratios=[1, 2])
    for name, axes in panels.items():
        size = 2.2 if name == "whole" else 5.0
        geometry(axes)
        if name != "whole":
            footprints(
                axes, body.x, body.y, body.spacing_x, body.spacing_y, facecolor="0.95", edgecolor="0.8"
            )
        _by_kind(axes, problem, body.x, body.y, size)
        _outline(axes, length, height)
    panels["whole"].set_xlim(-0.02 * length, 1.02 * length)
    panels["whole"].set_ylim(-height, height)
    # Between rectangles, so that none is cut.
    panels["wall"].set_xlim(body.x.min() - body.spacing_x, 8.5 * body.spacing_x)
    last = body.x.max() + 0.5 * body.spacing_x
    panels["end"].set_xlim(last - 9.0 * body.spacing_x, last + 0.5 * body.spacing_x)
    for name in ("wall", "end"):
        panels[name].set_ylim(-0.62 * height, 0.62 * height)
    handles, labels = panels["end"].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return drawing


def _by_kind(axes: Axes, problem: Problem, x: np.ndarray, y: np.ndarray, size: float) -> None:
    """Particles at x, y [N]: free, fixed in both directions, prescribed in y alone, and the tracked one
    of a plate that vibrates.
    """
    constraints = problem.constraints
    fixed = np.zeros(x.size, dtype=bool)
    fixed[constraints.x_index] = True
    driven = np.zeros(x.size, dtype=bool)
    driven[constraints.y_index] = True
    driven &= ~fixed
    kinds = {"free": ~fixed & ~driven, "fixed": fixed}
    if driven.any():
        kinds["prescribed"] = driven
    else:
        kinds["tracked"] = np.arange(x.size) == problem.tracked
        kinds["free"] &= ~kinds["tracked"]
    for kind, chosen in kinds.items():
        scale = {"tracked": 2.2, "prescribed": 1.3}.get(kind, 1.0)
        label = "prescribed in y" if kind == "prescribed" else kind
        particles(axes, x[chosen], y[chosen], kind, label, markersize=scale * size, markeredgewidth=0.6)


def _outline(axes: Axes, length: float, height: float) -> None:
    """The plate's edges, which particles reach with their rectangles but not with their centres."""
    corners_x, corners_y = np.array([0, 1, 1, 0, 0]) * length, np.array([-1, -1, 1, 1, -1]) * 0.5 * height
    axes.plot(
        corners_x, corners_y, "--", color="C0", linewidth=1.0, zorder=1.9, label="edges of the plate"
    )


def _bent(config, problem: Problem, factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions [N] (m) of the particles, bent as the beam is, with `factor` times its deflection."""
    scene, body = config.scene, problem.body
    deflection = scene.deflection * scene.L * factor

    def centreline(x):
        return beam.bent_centreline(x, deflection, scene.L, body.spacing_x)

    # The centreline is a cubic: a central difference over a small step has its slope.
    step = 1e-3 * body.spacing_x
    slope = (centreline(body.x + step) - centreline(body.x - step)) / (2.0 * step)
    angle = np.arctan(slope)
    return body.x - body.y * np.sin(angle), centreline(body.x) + body.y * np.cos(angle)


@figure(
    "3.4",
    "Plate with its end prescribed: where the particles start (grey) and, true to scale, where the "
    "beam's deflection takes them. Those of the last column are driven in y and free in x.",
)
def prescribed_end(results: Results) -> Figure:
    """Particles of the bending plate, no finer than nine rows, before and after."""
    config, problem, length, height = _coarse(results, "bending")
    body = problem.body
    x, y = _bent(config, problem, 1.0)

    drawing = Figure(figsize=(TEXT_WIDTH, 1.75), layout="constrained")
    axes = drawing.add_subplot()
    particles(axes, body.x, body.y, "reference", "at the start", markersize=1.5)
    _by_kind(axes, problem, x, y, 2.2)
    target = config.scene.deflection * length
    arrow = 1.025 * length
    _dimension(axes, (arrow, 0.0), (arrow, target), f"|u$_p$| = {abs(target):g} m")
    geometry(axes)
    axes.set_xlim(-0.02 * length, 1.26 * length)
    axes.set_ylim(-1.2 * height, 0.8 * height)
    drawing.legend(loc="outside lower center", ncols=4, markerscale=2)
    return drawing


@figure(
    "3.5",
    f"The end of the plate, its deflection {_EXAGGERATION} times as large as it is, and how the end "
    "angle is found: a line is fitted to the driven column of particles; θ is its angle to the upright.",
)
def end_angle(results: Results) -> Figure:
    """The last columns of the bent plate, the fitted line and its angle."""
    config, problem, _, height = _coarse(results, "bending")
    body = problem.body
    x, y = _bent(config, problem, _EXAGGERATION)
    end = body.tags["end"]
    shown = body.x > body.x[end][0] - 10.5 * body.spacing_x
    angle = column_angle(x[end], y[end])
    middle = float(x[end].mean()), float(y[end].mean())
    reach = 0.8 * height

    drawing = Figure(figsize=(4.6, 4.2), layout="constrained")
    axes = drawing.add_subplot()
    for kind, chosen in (("free", shown & ~end), ("prescribed", shown & end)):
        label = "prescribed in y" if kind == "prescribed" else kind
        particles(axes, x[chosen], y[chosen], kind, label, markersize=7)
    along = np.array([-reach, reach])
    fitted = middle[0] - along * np.sin(angle), middle[1] + along * np.cos(angle)
    axes.plot(*fitted, color="C0", label="fitted line")
    axes.plot([middle[0]] * 2, middle[1] + along, "--", color="0.3", label="upright")
    first, last = sorted((90.0, 90.0 + np.degrees(angle)))
    axes.add_patch(Arc(middle, 1.5 * reach, 1.5 * reach, theta1=first, theta2=last, color="C6"))
    text_x, text_y = middle[0] - np.sin(0.5 * angle) * 0.86 * reach, middle[1] + 0.86 * reach
    axes.text(text_x, text_y, "θ", ha="center", va="center")
    geometry(axes)
    drawing.legend(loc="outside lower center", ncols=2)
    return drawing
