"""Crack, modes I and II: the deformed square, coloured by the stress that drives the crack."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.metrics.metric import snapshot
from sphstudy.model.exact import williams
from sphstudy.report.drawing import footprints, spacing
from sphstudy.report.figure import figures
from sphstudy.report.figures.crack import COMPONENTS
from sphstudy.store.record import configuration

_KILOPASCAL = 1e3


def caption(mode: str, coloured_by: str, crack: str, method: str = "") -> str:
    """The caption of the square in that mode; crack: what it does; method: "<method>, " or nothing."""
    return (
        f"Particles of the mode {mode} square at their positions at equilibrium (not exaggerated), "
        f"{method}cell (n_x, h̃) = (60, 1.7), coloured by {coloured_by}. {crack} Colours end at the exact "
        "stress a twentieth of the side ahead of the tip."
    )


OPENING = "I", "σ_yy", "The crack gapes on the left."
SLIDING = "II", "σ_xy", "The faces of the crack on the left slide."


@figures(
    mode1_field=("deformed square, opening", caption(*OPENING), "yy"),
    mode2_field=("deformed square, sliding", caption(*SLIDING), "xy"),
)
def _field(results: Results, component: str) -> Figure:
    return draw(results, component)


def draw(results: Results, component: str) -> Figure:
    """The particles at equilibrium in the cell of the captions, coloured by a component of the stress."""
    run = results.record({"h": 1.7, "n": 60}, block="grid")
    scene, state = configuration(run).scene, snapshot(run, "settle")
    ahead = williams.stress(scene.mode, np.array(scene.L / 20.0), np.array(0.0), scene.K)
    limit = float(ahead[COMPONENTS.index(component)]) / _KILOPASCAL
    stress = state[f"stress_{component}"].values / _KILOPASCAL

    drawing = Figure(figsize=(5.0, 4.2), layout="constrained")
    axes = drawing.subplots()
    # Edges wide enough to close the slits that stretching opens between neighbours.
    options: dict[str, Any] = {"clim": (0.0, limit), "linewidth": 1.0}
    colours = footprints(axes, state["x"].values, state["y"].values, *spacing(run), stress, **options)
    axes.set(xlabel="$x$ (m)", ylabel="$y$ (m)", aspect="equal")
    axes.grid(False)
    axes.locator_params(nbins=5)
    drawing.colorbar(colours, ax=axes, extend="both", label=f"$\\sigma_{{{component}}}$ (kPa)")
    return drawing
