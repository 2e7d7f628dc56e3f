"""Centreline and end angle of the bending plate, against the beam and against 2-D elasticity."""

import numpy as np
import xarray as xr
from scipy.interpolate import make_interp_spline

from sphstudy.metrics.metric import Metric, snapshot
from sphstudy.metrics.roughness import deviation
from sphstudy.model.exact import beam
from sphstudy.model.exact.elasticity2d import bent_plate
from sphstudy.model.material import Material

WALL, END = 0.15, 0.9
"""Figures 4.7a and 4.7b show boundary effects for x0 < WALL and x0 > END, in lengths of the plate."""


def column_angle(x: np.ndarray, y: np.ndarray) -> float:
    """Rotation (rad, positive anticlockwise) of an upright column of particles at x, y [M] (m).

    A line is fitted x on y, which is regular when the column is upright; the thesis's (3.5), y on x,
    gives the same angle modulo π and with the other sign.
    """
    return float(-np.arctan(np.polyfit(y, x, 1)[0]))


def boundary_roughness(x0: np.ndarray, error: np.ndarray, length: float) -> dict[str, Metric]:
    """Largest jag of the centreline near the wall, near the end, and between the two.

    x0, error [M] (m): particles of the centreline in order and what u_y has beyond a smooth curve. A
    jag is the error's deviation from the mean of its two neighbours: of second order in the spacing on
    a smooth curve, however wrong, and as large as the error where that goes up and down from particle
    to particle. A part without particles is left out.
    """
    jag, at = np.abs(deviation(error[None])[0]), x0[1:-1] / length
    parts = (
        ("wall", "near the wall", at < WALL),
        ("middle", "in the middle of the span", (at >= WALL) & (at <= END)),
        ("end", "near the end", at > END),
    )
    return {
        f"centreline_roughness_{part}": Metric(
            float(jag[there].max()), "m", f"largest jag of the centreline {where}"
        )
        for part, where, there in parts
        if there.any()
    }


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Metrics of the bent plate at the end of settling (thesis 3.2, 4.2)."""
    scene = config.scene
    height, deflection = scene.L / scene.slenderness, scene.deflection * scene.L
    spacing = float(run["spacing_x"])
    state = snapshot(run, "settle")
    end, centre = run["tag_end"].values == 1, run["tag_centreline"].values == 1
    x0 = run["reference_x"].values[centre]
    u_y = (state["y"] - run["reference_y"]).values[centre]
    angle = column_angle(state["x"].values[end], state["y"].values[end])
    beam_angle = beam.end_angle(deflection, scene.L, spacing)
    error = u_y - beam.bent_centreline(x0, deflection, scene.L, spacing)
    # The particles that are driven stand at L - Δx/2: that is where the body's end is moved.
    length = float(run["reference_x"].max())
    material = Material(scene.E, scene.nu, scene.rho, scene.plane)
    plate = bent_plate(length, height, material, deflection)
    error_2d = u_y - make_interp_spline(plate.x, plate.u_y)(x0)
    energy = float(state["snapshot_strain_energy"])
    degrees = "degree"
    return {
        "end_angle": Metric(np.degrees(angle), degrees, "angle of the driven end"),
        "end_angle_error": Metric(
            np.degrees(angle - beam_angle), degrees, "error of the end angle against the beam"
        ),
        "end_angle_error_2d": Metric(
            np.degrees(angle - plate.end_angle.value),
            degrees,
            "error of the end angle against 2-D elasticity",
        ),
        "centreline_error_max": Metric(
            np.abs(error).max(), "m", "largest error of u_y on the centreline against the beam"
        ),
        "centreline_error_rms": Metric(
            np.sqrt(np.mean(error**2)), "m", "rms error of u_y on the centreline against the beam"
        ),
        "centreline_error_2d": Metric(
            np.abs(error_2d).max(), "m", "largest error of u_y on the centreline against 2-D elasticity"
        ),
        "bending_energy_error": Metric(
            energy / plate.strain_energy.value - 1.0,
            "1",
            "relative error of the strain energy against 2-D elasticity",
        ),
        "bending_energy_2d_uncertainty": Metric(
            plate.strain_energy.error, "J m-1", "error estimate of the 2-D energy"
        ),
        **boundary_roughness(x0, error, scene.L),
    }
