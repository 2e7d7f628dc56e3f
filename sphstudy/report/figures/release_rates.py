"""Crack, modes I and II, over h̃ for each n_x: energy release rates and error norms (thesis 4.3, 4.4)."""

from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.report.figure import figures
from sphstudy.report.series import PERCENT, RADIUS, curves, legend_above

_DISPLACEMENTS = {"u_x_rms": "$u_x$", "u_y_rms": "$u_y$"}
_STRESSES = {
    "stress_xx_rms": "$\\sigma_{xx}$",
    "stress_yy_rms": "$\\sigma_{yy}$",
    "stress_xy_rms": "$\\sigma_{xy}$",
}


_G1 = (
    "relative error of the energy release rate G1 by propagation of the crack (3.24) over h̃, for each "
    "n_x. The thesis:"
)
_G2 = (
    "relative error of the energy release rate G2 by projection of the displacements of the crack's "
    "faces over h̃, for each n_x, at equilibrium. The thesis:"
)
_U, _SIGMA = (
    f"error norms (rms over all particles) of the {fields} at equilibrium, each over its maximum on the "
    "grid. The thesis: they fall with n_x"
    for fields in ("displacements", "stresses")
)
_LOWEST = "and are lowest at h̃ = 1.3 for each n_x."


@figures(
    mode1_propagation=(
        "4.12a",
        f"Mode I: {_G1} all about -20 to -30 %, shrinking as n_x grows, except (40, 1.5), which is much "
        "lower.",
        1,
    ),
    mode1_projection=(
        "4.12b",
        f"Mode I: {_G2} a factor of 100 below G1, half of either sign, smallest at h̃ = 1.5 for each n_x, "
        "varying about 1 % over h̃.",
        2,
    ),
    mode2_propagation=(
        "4.16a",
        f"Mode II: {_G1} of order -20 to -30 %, shrinking slowly as n_x grows, lowest at h̃ = 1.3; (40, "
        "1.3) is exceptionally low and of the other sign.",
        1,
    ),
    mode2_projection=(
        "4.16b",
        f"Mode II: {_G2} 3 to 4.5 %, shrinking as n_x grows, smallest at h̃ = 1.9, varying about 0.5 % "
        "over h̃.",
        2,
    ),
)
def _errors(results: Results, estimate: int) -> Figure:
    """Error of the release rate by propagation (estimate 1) or projection (2)."""
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    curves(axes, PERCENT * results.grid(f"G{estimate}_error"), "n_x")
    axes.set(xlabel=RADIUS, ylabel=f"error of release rate $(G_{estimate}-G)/G$ (%)")
    legend_above(drawing, axes, columns=3)
    return drawing


@figures(
    mode1_displacement_norms=(
        "4.13a",
        f"Mode I: {_U} and favour low h̃; at large h̃ they fall faster.",
        _DISPLACEMENTS,
    ),
    mode1_stress_norms=(
        "4.13b",
        f"Mode I: {_SIGMA}; σ_xx and σ_yy favour h̃ = 1.3 and 1.5, σ_xy is larger at 1.3.",
        _STRESSES,
    ),
    mode2_displacement_norms=("4.17a", f"Mode II: {_U} {_LOWEST}", _DISPLACEMENTS),
    mode2_stress_norms=("4.17b", f"Mode II: {_SIGMA} {_LOWEST}", _STRESSES),
)
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
