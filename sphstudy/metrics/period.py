"""Period of a clamped plate against 2-D elasticity with the same clamp, and against the thin plate."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure
from sphstudy.metrics.swings import period, swings
from sphstudy.model.exact import beam
from sphstudy.model.exact.elasticity2d import Reference, plate_frequencies

ROWS = 10
"""Rows to which an error of second order in the spacing is scaled, so that one bound serves every n."""


def _exact_period(scene, n: int) -> Reference:
    """Period (s) of the body that the particles stand for, by finite elements, for small amplitudes."""
    length, held = scene.represented_length(n), scene.held_length(n)
    omega, _ = plate_frequencies(length, scene.height, scene.material, held)
    value = 2.0 * np.pi / omega.value
    return Reference(value, value * omega.error / omega.value)


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Errors of the period; of the amplitude too, where the scene gives the speed of the push."""
    if not run.sizes.get("sample"):
        return {}
    scene = config.scene
    found = swings(run["history_time"].values, run["history_u_y"].values)
    exact = _exact_period(scene, config.n)
    thin = beam.thin_plate_frequency(scene.E, scene.nu, scene.rho, scene.L, scene.height)
    thin_period, error = 2.0 * np.pi / thin, period(found) / exact.value - 1.0
    metrics = {
        "period_2d": Metric(exact.value, "s", "period by 2-D elasticity, same clamp, small amplitude"),
        "period_2d_uncertainty": Metric(exact.error, "s", "error estimate from mesh refinement"),
        "period_thin_plate": Metric(thin_period, "s", "period of the thin plate"),
        "period_error_2d": pure(error, "relative error of the period against 2-D elasticity"),
        "period_error_scaled": pure(
            abs(error) * (config.n / ROWS) ** 2,
            f"that error, scaled to {ROWS} rows as one of second order",
        ),
        "period_error_thin_plate": pure(
            period(found) / thin_period - 1.0, "relative difference of the period to the thin plate's"
        ),
    }
    if scene.push is not None and found.peaks.size:
        # The tracked particle stands half a cell before the free end: its own initial speed counts.
        tracked = float(beam.mode_shape(float(run["reference_x"].max()), scene.L))
        expected = scene.push * tracked * exact.value / (2.0 * np.pi)
        metrics["amplitude_error"] = pure(
            found.peaks[0] / expected - 1.0,
            "relative error of the first amplitude against v_tip(0)/ω, 2-D elasticity",
        )
    return metrics
