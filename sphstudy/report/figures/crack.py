"""Crack, modes I and II: displacements of its faces and stresses ahead of its tip (thesis 4.3, 4.4)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.metrics.metric import snapshot
from sphstudy.model.exact import williams
from sphstudy.report.figure import figures
from sphstudy.report.series import legend_above, zero_line
from sphstudy.store.record import configuration

_CELL = {"h": 1.7, "n": 60}
_MILLIMETRE, _MEGAPASCAL = 1e-3, 1e6

COMPONENTS = ("xx", "yy", "xy")
"""Of the stress, in the order of the exact solution."""

_ROWS = ((1.0, "above", "^"), (-1.0, "below", "v"))
"""Side of the crack's line, its name and marker."""


@figures(
    mode1_faces=(
        "4.10",
        "Mode I: u_y of the two rows of particles beside the crack's faces over their original x0, cell "
        "(n_x, h̃) = (60, 1.7) at equilibrium, and Williams' solution. Hollow: prescribed particles of "
        "the frame. The thesis: good agreement, except very near the tip at x0 = 0.",
        "y",
    ),
    mode2_faces=(
        "4.14",
        "Mode II: u_x of the two rows of particles beside the crack's faces over their original x0, "
        "cell (n_x, h̃) = (60, 1.7) at equilibrium, and Williams' solution. Hollow: prescribed "
        "particles of the frame. The thesis: very good agreement, the error growing towards the tip.",
        "x",
    ),
)
def _faces(results: Results, component: str) -> Figure:
    """Displacement `component` ("x" or "y") of the rows beside the crack's faces."""
    run = results.record(_CELL, block="grid")
    scene, state = configuration(run).scene, snapshot(run, "settle")
    u = state[component].values - run[f"reference_{component}"].values
    x = np.linspace(-0.5 * scene.L, 0.0, 300)
    y = np.full_like(x, 0.5 * float(run["spacing_y"]))
    exact = [
        williams.displacement(scene.mode, x, side * y, scene.K, scene.E, scene.nu)["xy".index(component)]
        for side, _, _ in _ROWS
    ]
    drawing = _rows(run, "faces", u / _MILLIMETRE, x, [values / _MILLIMETRE for values in exact])
    drawing.axes[0].set_ylabel(f"displacement $u_{component}$ (mm)")
    return drawing


@figures(
    mode1_stress_xx=(
        "4.11a",
        "Mode I: σ_xx of the two rows of particles ahead of the tip over their original x0, cell (n_x, "
        "h̃) = (60, 1.7) at equilibrium, and Williams' solution at these rows. Hollow: prescribed "
        "particles. The thesis: very good except very close to the tip, and a problem close to x0 = 0.1 "
        "m.",
        "xx",
    ),
    mode1_stress_yy=(
        "4.11b",
        "Mode I: σ_yy ahead of the tip, as figure 4.11a. The thesis: agrees very well, with a problem "
        "close to the boundary at x0 = 0.1 m.",
        "yy",
    ),
    mode1_stress_xy=(
        "4.11c",
        "Mode I: σ_xy ahead of the tip, as figure 4.11a; exactly, it has opposite signs in the two "
        "rows. The thesis: agrees very well except very close to the tip.",
        "xy",
    ),
    mode2_stress_xx=(
        "4.15a",
        "Mode II: σ_xx of the two rows of particles ahead of the tip over their original x0, cell (n_x, "
        "h̃) = (60, 1.7) at equilibrium, and Williams' solution at these rows. Hollow: prescribed "
        "particles. The thesis: should be antisymmetric about the x axis, but is not close to the tip.",
        "xx",
    ),
    mode2_stress_yy=(
        "4.15b",
        "Mode II: σ_yy ahead of the tip, as figure 4.15a. The thesis: should be antisymmetric too, but "
        "is not close to the tip.",
        "yy",
    ),
    mode2_stress_xy=(
        "4.15c",
        "Mode II: σ_xy ahead of the tip, as figure 4.15a; exactly, it is the same in the two rows. The "
        "thesis: looks particularly good.",
        "xy",
    ),
)
def _ahead(results: Results, component: str) -> Figure:
    """Stress `component` ("xx", "yy" or "xy") in the rows ahead of the tip."""
    run = results.record(_CELL, block="grid")
    drawing = _rows(run, "ahead", *stress_ahead(run, component, _MEGAPASCAL))
    drawing.axes[0].set_ylabel(f"stress $\\sigma_{{{component}}}$ (MPa)")
    return drawing


def stress_ahead(
    run: xr.Dataset, component: str, unit: float
) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """A stress at equilibrium, and Williams' in the two rows ahead of the tip.

    Parameters
    ----------
    run : xarray.Dataset
        Record of a crack.
    component : {"xx", "yy", "xy"}
        Of the stress.
    unit : float
        Of the stresses returned (Pa).

    Returns
    -------
    stress : array [N]
        Of all particles.
    x : array [M]
        Places (m) of the exact stresses. They begin at the first particle: there is nothing to compare
        with before.
    exact : list of two arrays [M]
        In the row above the crack's line, and in the row below.
    """
    scene = configuration(run).scene
    half = 0.5 * float(run["spacing_y"])
    x = half + (0.5 * scene.L - half) * np.linspace(0.0, 1.0, 400) ** 2
    exact = [
        williams.stress(scene.mode, x, np.full_like(x, side * half), scene.K)[COMPONENTS.index(component)]
        for side, _, _ in _ROWS
    ]
    stress = snapshot(run, "settle")[f"stress_{component}"].values
    return stress / unit, x, [values / unit for values in exact]


def _rows(run: xr.Dataset, tag: str, values: np.ndarray, x: np.ndarray, exact: list) -> Figure:
    """Values [N] of the tagged particles in the row above and the row below, exact [2][M] at x [M]."""
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    chosen, frame = run[f"tag_{tag}"].values == 1, run["tag_frame"].values == 1
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    for side, name, marker in _ROWS:
        row = chosen & (side * y0 > 0.0)
        label = f"SPH, row {name}"
        (line,) = axes.plot(x0[row & ~frame], values[row & ~frame], marker, label=label)
        colour = line.get_color()
        axes.plot(x0[row & frame], values[row & frame], marker, color=colour, markerfacecolor="white")
    above, below = exact
    if np.allclose(above, below):
        axes.plot(x, above, color="0.2", linewidth=1.2, label="exact, both rows")
    else:
        axes.plot(x, above, color="0.2", linewidth=1.2, label="exact, row above")
        axes.plot(x, below, "--", color="0.2", linewidth=1.2, label="exact, row below")
    zero_line(axes)
    axes.set_xlabel("$x_0$ (m)")
    legend_above(drawing, axes, columns=2)
    return drawing
