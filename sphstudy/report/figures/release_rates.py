"""Crack, modes I and II, over h̃ for each n_x: energy release rates and error norms (thesis 4.3, 4.4)."""

from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.report.figure import figure
from sphstudy.report.series import PERCENT, RADIUS, curves, legend_above

_DISPLACEMENTS = {"u_x_rms": "$u_x$", "u_y_rms": "$u_y$"}
_STRESSES = {
    "stress_xx_rms": "$\\sigma_{xx}$",
    "stress_yy_rms": "$\\sigma_{yy}$",
    "stress_xy_rms": "$\\sigma_{xy}$",
}


@figure(
    "4.12a",
    "Mode I: relative error of the energy release rate G1 by propagation of the crack (3.24) over h̃, "
    "for each n_x. The thesis: all about -20 to -30 %, shrinking as n_x grows, except (40, 1.5), which "
    "is much lower.",
)
def mode1_propagation(results: Results) -> Figure:
    return _errors(results, 1)


@figure(
    "4.12b",
    "Mode I: relative error of the energy release rate G2 by projection of the displacements of the "
    "crack's faces over h̃, for each n_x, at equilibrium. The thesis: a factor of 100 below G1, half "
    "of either sign, smallest at h̃ = 1.5 for each n_x, varying about 1 % over h̃.",
)
def mode1_projection(results: Results) -> Figure:
    return _errors(results, 2)


@figure(
    "4.16a",
    "Mode II: relative error of the energy release rate G1 by propagation of the crack (3.24) over h̃, "
    "for each n_x. The thesis: of order -20 to -30 %, shrinking slowly as n_x grows, lowest at h̃ = "
    "1.3; (40, 1.3) is exceptionally low and of the other sign.",
)
def mode2_propagation(results: Results) -> Figure:
    return _errors(results, 1)


@figure(
    "4.16b",
    "Mode II: relative error of the energy release rate G2 by projection of the displacements of the "
    "crack's faces over h̃, for each n_x, at equilibrium. The thesis: 3 to 4.5 %, shrinking as n_x "
    "grows, smallest at h̃ = 1.9, varying about 0.5 % over h̃.",
)
def mode2_projection(results: Results) -> Figure:
    return _errors(results, 2)


@figure(
    "4.13a",
    "Mode I: error norms (rms over all particles) of the displacements at equilibrium, each over its "
    "maximum on the grid. The thesis: they fall with n_x and favour low h̃; at large h̃ they fall "
    "faster.",
)
def mode1_displacement_norms(results: Results) -> Figure:
    return _norms(results, _DISPLACEMENTS)


@figure(
    "4.13b",
    "Mode I: error norms (rms over all particles) of the stresses at equilibrium, each over its "
    "maximum on the grid. The thesis: they fall with n_x; σ_xx and σ_yy favour h̃ = 1.3 and 1.5, σ_xy "
    "is larger at 1.3.",
)
def mode1_stress_norms(results: Results) -> Figure:
    return _norms(results, _STRESSES)


@figure(
    "4.17a",
    "Mode II: error norms (rms over all particles) of the displacements at equilibrium, each over its "
    "maximum on the grid. The thesis: they fall with n_x and are lowest at h̃ = 1.3 for each n_x.",
)
def mode2_displacement_norms(results: Results) -> Figure:
    return _norms(results, _DISPLACEMENTS)


@figure(
    "4.17b",
    "Mode II: error norms (rms over all particles) of the stresses at equilibrium, each over its "
    "maximum on the grid. The thesis: they fall with n_x and are lowest at h̃ = 1.3 for each n_x.",
)
def mode2_stress_norms(results: Results) -> Figure:
    return _norms(results, _STRESSES)


def _errors(results: Results, estimate: int) -> Figure:
    """Error of the release rate by propagation (estimate 1) or projection (2)."""
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    curves(axes, PERCENT * results.grid(f"G{estimate}_error"), "n_x")
    axes.set(xlabel=RADIUS, ylabel=f"error of release rate $(G_{estimate}-G)/G$ (%)")
    legend_above(drawing, axes, columns=3)
    return drawing


def _norms(results: Results, fields: dict[str, str]) -> Figure:
    """A panel for each field: its norm over the largest on the grid. `fields`: metric to symbol."""
    drawing = Figure(figsize=(6.6, 3.2), layout="constrained")
    panels = drawing.subplots(1, len(fields), sharey=True)
    for axes, (metric, symbol) in zip(panels, fields.items(), strict=True):
        grid = results.grid(metric)
        curves(axes, grid / grid.max(axis=None), "n_x")
        axes.set_title(symbol)
    drawing.supxlabel(RADIUS, fontsize="medium")
    panels[0].set(ylabel="error norm over its maximum", ylim=(0.0, 1.05))
    legend_above(drawing, panels[0], columns=3)
    return drawing
