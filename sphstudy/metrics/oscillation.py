"""Frequency, amplitude and decay of the vibrating plate, against the beam and against 2-D elasticity."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.optimize import least_squares
from scipy.special import stdtrit

from sphstudy.metrics.metric import Metric, pure
from sphstudy.model.exact import beam
from sphstudy.model.exact.elasticity2d import Reference, plate_frequencies


@dataclass(frozen=True)
class DampedSine:
    """u = A exp(-κt) sin ωt (3.3): A (m), κ (1/s), ω (rad/s), and half-widths of 95 % intervals.

    `residual`: rms of what the fit leaves, over |A|. The intervals take the residuals for independent
    noise; where the model itself does not fit, the residual says more.
    """

    amplitude: float
    decay: float
    omega: float
    amplitude_interval: float
    decay_interval: float
    omega_interval: float
    residual: float


def fit_damped_sine(time: np.ndarray, displacement: np.ndarray, omega_guess: float) -> DampedSine:
    """Least-squares fit of (3.3) to samples.

    Parameters
    ----------
    time, displacement : array [M]
        Samples (s), (m).
    omega_guess : float
        Angular frequency (rad/s): any ω from 0.3 to 3 times the guess is found, and returned positive.

    Raises
    ------
    ValueError
        If there are fewer than five samples, if one is not finite, if all displacements are zero, or if
        the samples span no time.
    """
    time, displacement = np.asarray(time, float), np.asarray(displacement, float)
    if time.ndim != 1 or time.size < 5 or time.shape != displacement.shape:
        raise ValueError(f"{time.size} samples: at least 5 times with as many displacements needed")
    if not (np.isfinite(time).all() and np.isfinite(displacement).all()):
        raise ValueError("samples that are not finite")
    if not (np.isfinite(omega_guess) and omega_guess > 0.0):
        raise ValueError(f"omega_guess = {omega_guess}: must be positive")
    size = float(np.abs(displacement).max())
    if size == 0.0:
        raise ValueError("nothing moves")
    if np.ptp(time) == 0.0:
        raise ValueError("samples that span no time")
    scaled_time, scaled = time * omega_guess, displacement / size

    def misfit(p):
        return p[0] * np.exp(-p[1] * scaled_time) * np.sin(p[2] * scaled_time) - scaled

    best = least_squares(misfit, _start(scaled_time, scaled), x_scale="jac", xtol=1e-12, ftol=1e-12)
    freedom = time.size - 3
    covariance = np.linalg.pinv(best.jac.T @ best.jac) * 2.0 * best.cost / freedom
    half = stdtrit(freedom, 0.975) * np.sqrt(np.diag(covariance)) * (size, omega_guess, omega_guess)
    amplitude, decay, omega = best.x * (size, omega_guess, omega_guess)
    residual = np.sqrt(2.0 * best.cost / time.size) / abs(best.x[0])
    intervals = (float(half[0]), float(half[1]), float(half[2]))
    return DampedSine(float(amplitude), float(decay), float(omega), *intervals, float(residual))


def _start(time: np.ndarray, displacement: np.ndarray) -> tuple[float, float, float]:
    """Best A, κ, ω on a grid, with time in units of 1/guess.

    The misfit has local minima in ω about 2π/span apart, so the grid is finer than that. A enters
    linearly: its best value for each κ and ω is a projection.
    """
    span = np.ptp(time)
    # Beyond 300 decay times in a record, envelopes would underflow.
    rates = np.geomspace(0.5 / span, min(1.0, 300.0 / span), 12)
    decays = np.concatenate((-rates, (0.0,), rates))
    exponents = -decays[:, None] * time
    peaks = exponents.max(axis=1)
    envelopes = np.exp(exponents - peaks[:, None])
    weights, squares = envelopes * displacement, envelopes**2
    gain, best = -1.0, (0.0, 0.0, 1.0)
    for omega in np.arange(0.3, 3.0, min(0.1, 0.5 / span)):
        sine = np.sin(omega * time)
        overlaps, norms = weights @ sine, squares @ sine**2
        gains = overlaps**2 / norms
        k = int(np.argmax(gains))
        if gains[k] > gain:
            gain = gains[k]
            best = (overlaps[k] / norms[k] * np.exp(-peaks[k]), decays[k], omega)
    return best


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Metrics of the vibrating plate (thesis 3.1, 4.1): from the motion of its tip, or from its modes."""
    scene = config.scene
    beam_omega = beam.fundamental_frequency(scene.E, scene.rho, scene.L, scene.height)
    length = scene.represented_length(config.n)
    plate, second = plate_frequencies(length, scene.height, scene.material)
    exact = {
        "frequency_2d": Metric(plate.value, "rad s-1", "ω1 of the body represented, 2-D elasticity"),
        "frequency_2d_uncertainty": Metric(
            plate.error, "rad s-1", "error estimate of that reference from mesh refinement"
        ),
    }
    own = (
        _of_modes(run, config, second) if "mode_frequency" in run else _of_motion(run, config, beam_omega)
    )
    omega, remark = own["frequency"].value, own["frequency"].remark
    return (
        own
        | {
            "frequency_error": pure(
                omega / beam_omega - 1.0, "relative error of ω against the beam's ω0", remark
            ),
            "frequency_error_2d": pure(
                omega / plate.value - 1.0, "relative error of ω against 2-D elasticity"
            ),
        }
        | exact
    )


MAIN_SHARE = 0.5
"""Least share of the initial kinetic energy with which a mode is taken for the fundamental one."""


def _of_modes(run: xr.Dataset, config, second: Reference) -> dict[str, Metric]:
    """Frequency of the mode that carries the initial motion, and of the next one that does."""
    omega, share = run["mode_frequency"].values, run["mode_participation"].values
    main = int(np.argmax(share))
    found = float(share[main]) >= MAIN_SHARE
    remark = "" if found else f"none of the {omega.size} lowest modes is the fundamental one"
    metrics = {
        "frequency": Metric(
            omega[main] if found else np.nan,
            "rad s-1",
            "angular frequency of the mode that carries the initial motion",
            remark,
        ),
        "main_participation": pure(share[main], "its share of the initial kinetic energy"),
        "spurious_modes": pure(
            main if found else omega.size, "modes below it (or all, if it was not found)"
        ),
        "modes_residual": pure(
            float(run["mode_residual"].max()), "largest |Kφ - ω²Mφ| over (ω² + shift) |Mφ|"
        ),
    }
    # Of a slender plate the next mode is the second in bending, unless modes without energy come between.
    if found and main == 0 and config.method.hourglass > 0.0 and omega.size > 1:
        metrics["second_frequency_error_2d"] = pure(
            omega[1] / second.value - 1.0, "relative error of the next frequency against ω2, 2-D"
        )
    return metrics


def _of_motion(run: xr.Dataset, config, beam_omega: float) -> dict[str, Metric]:
    """Fit of (3.3) to the displacement of the tip."""
    scene = config.scene
    time, u_y = run["history_time"].values, run["history_u_y"].values
    fit = fit_damped_sine(time, u_y, beam_omega)
    target = scene.H0 * scene.L
    # The tracked particle stands half a cell before the free end: its own initial speed counts.
    tracked_x = float(run["reference_x"].max())
    speed = target * beam_omega * float(beam.mode_shape(tracked_x, scene.L))
    return {
        "frequency": Metric(fit.omega, "rad s-1", "angular frequency ω of the fit"),
        "frequency_interval": Metric(
            fit.omega_interval, "rad s-1", "half-width of the 95 % interval of ω"
        ),
        "amplitude": Metric(fit.amplitude, "m", "amplitude A of the fit"),
        "amplitude_interval": Metric(fit.amplitude_interval, "m", "half-width of the 95 % interval of A"),
        "amplitude_error": pure(fit.amplitude / target - 1.0, "relative error of A"),
        "largest_displacement": Metric(float(np.abs(u_y).max()), "m", "largest |u_y| of the tip"),
        "amplitude_frequency_product": pure(
            fit.amplitude * fit.omega / speed, "A ω / v_tip(0): 1 without loss of energy"
        ),
        "decay_rate": Metric(fit.decay, "s-1", "decay rate κ of the fit"),
        "decay_rate_interval": Metric(fit.decay_interval, "s-1", "half-width of the 95 % interval of κ"),
        "fit_residual": pure(fit.residual, "rms residual of the fit over A"),
    }
