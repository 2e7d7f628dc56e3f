"""Noise of a step load behind its front, and what is left of a single displaced particle's offset."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure
from sphstudy.model.exact.waves import longitudinal_speed, stopped_bar, stopped_chain
from sphstudy.numerics.sph.kernel import KERNELS

PLATEAU_END = 0.8
"""Share of the front's way up to which the state behind it counts as plateau; the front is beyond."""

LATE = 0.75
"""Share of the run after which what is left of the particle's offset is measured."""


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Metrics of whichever shock the scene has. Of modes, nothing."""
    if not run.sizes.get("sample"):
        return {}
    return _wave(run, config) if config.scene.shock == "wave" else _particle(run)


def _wave(run: xr.Dataset, config) -> dict[str, Metric]:
    """At the end, over all particles not held, against d'Alembert in the reference configuration."""
    scene, state = config.scene, run.isel(snapshot=-1)
    material = scene.material
    sound = longitudinal_speed(material)
    speed, time = scene.strength * sound, float(state["snapshot_time"])
    free = run["tag_held"].values == 0
    x = run["reference_x"].values[free]
    velocity = state["velocity_x"].values[free] / speed
    stress = -state["stress_xx"].values[free] / (material.density * sound * speed)
    exact = stopped_bar(x, time, speed, material)[1] / speed
    spacing, front = float(run["spacing_x"]), sound * time
    support = config.h * KERNELS[config.method.kernel].support * spacing
    plateau = (x > support) & (x < PLATEAU_END * front)
    noise = float(np.sqrt(np.mean(velocity[plateau] ** 2)))
    chain = stopped_chain(np.round(x[plateau] / spacing).astype(int), front / spacing)
    return {
        "velocity_error": pure(
            np.abs(velocity - exact).mean(), "mean |v_x - exact| over the bar's speed"
        ),
        "stress_overshoot": pure(
            float(stress.max()) - 1.0, "largest -σ_xx over the exact one, ρ c v, less one"
        ),
        "plateau_stress_error": pure(
            float(stress[plateau].mean()) - 1.0, "relative error of the mean stress behind the front"
        ),
        "plateau_noise": pure(noise, "rms velocity where the front has passed, over the bar's speed"),
        "plateau_noise_ratio": pure(
            noise / float(np.sqrt(np.mean(chain**2))),
            "this noise over that of a chain of masses and springs, one to a spacing",
        ),
        "front_lag": pure(
            (front - _front(x, velocity)) / spacing,
            "how far the front, where the bar has half its speed, is behind the exact one, in spacings",
        ),
    }


def _front(x: np.ndarray, velocity: np.ndarray) -> float:
    """Largest x (m) at which the mean over the rows of velocity [N] (from 0 to -1) rises through -1/2."""
    column, row_of = np.unique(x, return_inverse=True)
    mean = np.bincount(row_of, velocity) / np.bincount(row_of)
    k = int(np.flatnonzero((mean[:-1] > -0.5) & (mean[1:] <= -0.5)).max(initial=-1))
    if k < 0:
        return np.nan
    share = (mean[k] + 0.5) / (mean[k] - mean[k + 1])
    return float(column[k] + share * (column[k + 1] - column[k]))


def _particle(run: xr.Dataset) -> dict[str, Metric]:
    """From the history of the particle and of the checkerboard."""
    time, amplitude = run["history_time"].values, run["history_hourglass_amplitude"].values
    offset = np.hypot(run["history_u_x"].values, run["history_u_y"].values)
    late = time >= LATE * time[-1]
    return {
        "offset_left": pure(
            np.sqrt(np.mean(offset[late] ** 2)) / offset[0],
            "rms offset of the displaced particle in the last quarter of the run, over its first",
        ),
        "hourglass_left": pure(
            np.sqrt(np.mean(amplitude[late] ** 2)) / amplitude[0],
            "rms checkerboard amplitude in the last quarter of the run, over the first",
        ),
    }
