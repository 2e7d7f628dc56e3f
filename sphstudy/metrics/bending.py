"""Centreline and end angle of the bending plate, against the beam and against 2-D elasticity."""

import numpy as np
import xarray as xr
from scipy.interpolate import make_interp_spline

from sphstudy.metrics.metric import Metric, pure, snapshot
from sphstudy.metrics.roughness import deviation
from sphstudy.model.exact import beam
from sphstudy.model.exact.elasticity2d import bent_plate

WALL, END = 0.15, 0.9
"""Figures 4.7a and 4.7b show boundary effects for x0 < WALL and x0 > END, in lengths of the plate."""


def column_angle(x: np.ndarray, y: np.ndarray) -> float:
    """Rotation of an upright column of particles.

    A line is fitted x on y, which is regular when the column is upright; the thesis's (3.5), y on x,
    gives the same angle modulo π and with the other sign.

    Parameters
    ----------
    x, y : array [M]
        Positions (m).

    Returns
    -------
    float
        Angle (rad), positive anticlockwise.
    """
    return float(-np.arctan(np.polyfit(y, x, 1)[0]))


def boundary_roughness(x0: np.ndarray, error: np.ndarray, length: float) -> dict[str, Metric]:
    """Largest jag of the centreline near the wall, near the end, and between the two.

    A jag is the error's deviation from the mean of its two neighbours: of second order in the spacing on
    a smooth curve, however wrong, and as large as the error where that goes up and down from particle
    to particle. A part without particles is left out.

    Parameters
    ----------
    x0, error : array [M]
        Particles of the centreline in order, and their u_y less that of a smooth curve (m).
    length : float
        Length of the plate (m).
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
    scene, state = config.scene, snapshot(run, "settle")
    deflection, spacing = scene.deflection * scene.L, float(run["spacing_x"])
    end, centre = run["tag_end"].values == 1, run["tag_centreline"].values == 1
    x0 = run["reference_x"].values[centre]
    u_y = (state["y"] - run["reference_y"]).values[centre]
    angle = column_angle(state["x"].values[end], state["y"].values[end])
    beam_angle = beam.end_angle(deflection, scene.L, spacing)
    error = u_y - beam.bent_centreline(x0, deflection, scene.L, spacing)
    # The particles that are driven stand at L - Δx/2: that is where the body's end is moved.
    length = float(run["reference_x"].max())
    plate = bent_plate(length, scene.height, scene.material, deflection)
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
        "bending_energy_error": pure(
            energy / plate.strain_energy.value - 1.0,
            "relative error of the strain energy against 2-D elasticity",
        ),
        "bending_energy_2d_uncertainty": Metric(
            plate.strain_energy.error, "J m-1", "error estimate of the 2-D energy"
        ),
        **boundary_roughness(x0, error, scene.L),
    }
