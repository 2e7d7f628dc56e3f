"""The cracked square: set-up, displacements of its frame, marked particles, opening (thesis 3.3)."""

import itertools
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.catalogue import method_module
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.model.problem import Body, Problem, Stage
from sphstudy.numerics.sph.crack import line_of_sight, visible
from sphstudy.report.drawing import TEXT_WIDTH, built, first_configuration, geometry, particles
from sphstudy.report.figure import figure

_MAGNIFICATION = 10


def _coarse(results: Results) -> tuple[RunConfig, Problem]:
    """Configuration and scene of a square coarse enough to tell its particles apart."""
    config = first_configuration(results, "mode1")
    # Room for frame, tip and extensions is the least that the scene takes; eight more make a picture.
    least = 2 * (config.scene.frame_layers + config.scene.extensions + 2)
    config = replace(config, n=least + 8)
    return config, built(config)


def _sight(config: RunConfig, problem: Problem, stage: Stage) -> tuple[np.ndarray, np.ndarray, float]:
    """Nodes [K] (m) of the crack as a run opens it in that stage, in the reference configuration, and the
    tolerance with which visibility is judged.
    """
    method = method_module(config.method.kind)
    crack = method.model(problem, config, stage.crack_nodes).crack
    *_, node_x, node_y, tolerance, _ = line_of_sight(crack, problem.body.x, problem.body.y)
    return node_x, node_y, tolerance


def _draw_crack(axes: Axes, config: RunConfig, problem: Problem, label: str = "crack") -> None:
    """The crack before it is extended."""
    node_x, node_y, _ = _sight(config, problem, _settled(problem)[0])
    axes.plot(node_x, node_y, "-", color="C6", linewidth=2.0, label=label)


def _settled(problem: Problem) -> list[Stage]:
    """The stages in which the crack has its first length, and those after each extension."""
    return [stage for stage in problem.stages if stage.action == "settle"]


@figure(
    "3.6",
    "The cracked square, drawn with fewer particles than any that is computed. Displacements are "
    "prescribed on the frame of outermost particles; the crack runs from the left edge to the middle, "
    "its last node half a spacing before it.",
)
def setup(results: Results) -> Figure:
    """Particles by kind, and the crack."""
    config, problem = _coarse(results)
    body, frame = problem.body, problem.body.tags["frame"]
    drawing = Figure(figsize=(4.6, 4.8), layout="constrained")
    axes = drawing.add_subplot()
    particles(axes, body.x[~frame], body.y[~frame], "free")
    particles(axes, body.x[frame], body.y[frame], "prescribed")
    _draw_crack(axes, config, problem)
    _square(axes, config)
    drawing.legend(loc="outside lower center", ncols=3)
    return drawing


def _square(axes: Axes, config: RunConfig) -> None:
    """Axes whose ticks are at the edges of the square and in its middle."""
    half = 0.5 * config.scene.L
    geometry(axes)
    axes.set(xlim=(-1.05 * half, 1.05 * half), ylim=(-1.05 * half, 1.05 * half))
    axes.set(xticks=[-half, -0.5 * half, 0.0, 0.5 * half, half])
    axes.set(yticks=[-half, -0.5 * half, 0.0, 0.5 * half, half])


@figure(
    "3.7",
    "Displacements applied to the frame (a) in mode I and (b) in mode II, magnified "
    f"{_MAGNIFICATION} times. The line joins the outermost particles, from face to face of the crack.",
)
def frame_displacements(results: Results) -> Figure:
    """The frame before and after, both modes under the same stress intensity."""
    config, _ = _coarse(results)
    drawing = Figure(figsize=(TEXT_WIDTH, 3.9), layout="constrained")
    panels = drawing.subplots(1, 2, sharex=True, sharey=True)
    for axes, mode, title in zip(panels, (1, 2), ("(a) mode I", "(b) mode II"), strict=True):
        problem = built(replace(config, scene=replace(config.scene, mode=mode)))
        body, constraints = problem.body, problem.constraints
        x, y = body.x.copy(), body.y.copy()
        x[constraints.x_index] += _MAGNIFICATION * constraints.x_target
        y[constraints.y_index] += _MAGNIFICATION * constraints.y_target
        frame = constraints.x_index
        particles(axes, body.x[frame], body.y[frame], "reference", "at the start")
        round_it = _around(body)
        axes.plot(x[round_it], y[round_it], color="C1", linewidth=0.8)
        particles(axes, x[frame], y[frame], "prescribed", "displaced", markersize=3.5)
        _draw_crack(axes, config, problem, "crack at the start")
        geometry(axes)
        axes.set_title(title)
    panels[1].set_ylabel("")
    drawing.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return drawing


def _around(body: Body) -> np.ndarray:
    """Indices of the outermost particles, in order, from above the crack round to below it."""
    edge = np.maximum(np.abs(body.x), np.abs(body.y))
    outermost = np.flatnonzero(edge > edge.max() - 0.5 * body.spacing_x)
    # The polar angle is cut at ±π, where the crack is.
    return outermost[np.argsort(-np.arctan2(body.y[outermost], body.x[outermost]))]


@figure(
    "3.8",
    "Marked particles: (a) those of the crack's faces, by whose displacements K, and G2 from it, are "
    "determined; (b) those ahead of the tip, for which stresses are plotted. Triangles lie in the frame.",
)
def marked_particles(results: Results) -> Figure:
    """The two rows beside y = 0, left and right of the tip."""
    config, problem = _coarse(results)
    body = problem.body
    drawing = Figure(figsize=(TEXT_WIDTH, 3.9), layout="constrained")
    panels = drawing.subplots(1, 2, sharey=True)
    titles = {"faces": "(a) faces", "ahead": "(b) ahead of the tip"}
    for axes, (tag, title) in zip(panels, titles.items(), strict=True):
        chosen, frame = body.tags[tag], body.tags["frame"]
        particles(axes, body.x[~chosen], body.y[~chosen], "reference", "not marked")
        free, driven = chosen & ~frame, chosen & frame
        particles(axes, body.x[free], body.y[free], "marked", "marked, free")
        particles(axes, body.x[driven], body.y[driven], "prescribed", "marked, prescribed")
        _draw_crack(axes, config, problem)
        _square(axes, config)
        axes.set_title(title)
    panels[1].set_ylabel("")
    drawing.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return drawing


@figure(
    "3.9",
    "How the crack of length a is forced open, one spacing Δx at a time, to determine the energy release "
    "rate G1 (3.24). Thin lines join particles that see each other (only nearest ones are joined).",
)
def forced_opening(results: Results) -> Figure:
    """The neighbourhood of the tip in each stage: the crack, and the pairs that it has not cut."""
    config, problem = _coarse(results)
    body, stages = problem.body, _settled(problem)
    spacing = body.spacing_x
    near = np.flatnonzero((np.abs(body.x) < 4.0 * spacing) & (np.abs(body.y) < 2.0 * spacing))
    drawing = Figure(figsize=(4.8, 1.0 + 1.45 * len(stages)), layout="constrained")
    panels = drawing.subplots(len(stages), 1, sharex=True, squeeze=False)[:, 0]
    for extension, (axes, stage) in enumerate(zip(panels, stages, strict=True)):
        sight = _sight(config, problem, stage)
        pairs = _pairs_in_sight(body, near, sight)
        axes.plot(body.x[pairs], body.y[pairs], color="C5", linewidth=1.0)
        particles(axes, body.x[near], body.y[near], "free", "particle", markersize=6, zorder=3)
        axes.plot(
            sight[0], sight[1], "D-", color="C6", markersize=4, linewidth=2.0, label="crack, its nodes"
        )
        axes.axvline(0.0, color="0.4", linestyle="--", linewidth=0.9, label="x = 0")
        geometry(axes)
        axes.set_title(f"{extension + 1}: {('a', 'a + Δx', 'a + 2Δx')[extension]}")
        axes.set(xlim=(-4.2 * spacing, 4.2 * spacing), ylim=(-2.0 * spacing, 2.0 * spacing))
    for axes in panels[:-1]:
        axes.set_xlabel("")
    drawing.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return drawing


def _pairs_in_sight(
    body: Body, near: np.ndarray, sight: tuple[np.ndarray, np.ndarray, float]
) -> np.ndarray:
    """Pairs [2, M] of particles, side by side or diagonal to each other, that see each other."""
    x, y = body.x, body.y
    pairs = [
        (i, j)
        for i, j in itertools.combinations(near, 2)
        if np.hypot(x[i] - x[j], y[i] - y[j]) < 1.5 * body.spacing_x
        and visible(x[i], y[i], x[j], y[j], *sight)
    ]
    return np.transpose(pairs)
