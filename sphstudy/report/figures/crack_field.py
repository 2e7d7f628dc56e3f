"""Crack, modes I and II: the deformed square, coloured by the stress that drives the crack."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.metrics.metric import snapshot
from sphstudy.model.exact import williams
from sphstudy.report.drawing import footprints
from sphstudy.report.figure import figure
from sphstudy.store.record import configuration

_KILOPASCAL = 1e3


@figure(
    "deformed square, opening",
    "Particles of the mode I square at their positions at equilibrium (not exaggerated), cell (n_x, "
    "h̃) = (60, 1.7), coloured by σ_yy. The crack gapes on the left. Colours end at the exact stress a "
    "twentieth of the side ahead of the tip.",
)
def mode1_field(results: Results) -> Figure:
    return _field(results, "yy")


@figure(
    "deformed square, sliding",
    "Particles of the mode II square at their positions at equilibrium (not exaggerated), cell (n_x, "
    "h̃) = (60, 1.7), coloured by σ_xy. The faces of the crack on the left slide. Colours end at the "
    "exact stress a twentieth of the side ahead of the tip.",
)
def mode2_field(results: Results) -> Figure:
    return _field(results, "xy")


def _field(results: Results, component: str) -> Figure:
    run = results.record({"h": 1.7, "n": 60}, block="grid")
    scene, state = configuration(run).scene, snapshot(run, "settle")
    ahead = williams.stress(scene.mode, np.array(scene.L / 20.0), np.array(0.0), scene.K)
    limit = float(ahead[("xx", "yy", "xy").index(component)]) / _KILOPASCAL
    stress = state[f"stress_{component}"].values / _KILOPASCAL

    drawing = Figure(figsize=(5.0, 4.2), layout="constrained")
    axes = drawing.subplots()
    spacing = float(run["spacing_x"]), float(run["spacing_y"])
    # Edges wide enough to close the slits that stretching opens between neighbours.
    options: dict[str, Any] = {"clim": (0.0, limit), "linewidth": 1.0}
    colours = footprints(axes, state["x"].values, state["y"].values, *spacing, stress, **options)
    axes.set(xlabel="$x$ (m)", ylabel="$y$ (m)", aspect="equal")
    axes.grid(False)
    axes.locator_params(nbins=5)
    drawing.colorbar(colours, ax=axes, extend="both", label=f"$\\sigma_{{{component}}}$ (kPa)")
    return drawing
