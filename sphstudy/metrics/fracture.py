"""Energy release rates G1 (propagation) and G2 (projection), stress intensities from the crack faces."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure, snapshot
from sphstudy.model.exact import williams


class StressIntensity(NamedTuple):
    """K (Pa √m) and its standard error."""

    value: float
    standard_error: float


def fit_stress_intensity(
    mode: int,
    x0: np.ndarray,
    y0: np.ndarray,
    displacement: np.ndarray,
    youngs_modulus: float,
    poisson_ratio: float,
) -> StressIntensity:
    """Least-squares stress intensity of one mode, with Williams' displacement for K = 1 as the basis.

    Parameters
    ----------
    mode : {1, 2}
        1: K_I, from u_y; 2: K_II, from u_x.
    x0, y0 : array [M]
        Reference positions of particles, the tip at the origin (m).
    displacement : array [M]
        Their u_y or u_x (m).
    youngs_modulus, poisson_ratio : float
        E (Pa) and ν.

    Raises
    ------
    ValueError
        If no particle moves in that field.
    """
    component = 1 if mode == 1 else 0
    basis = williams.displacement(mode, x0, y0, 1.0, youngs_modulus, poisson_ratio)[component]
    square = float(basis @ basis)
    if square == 0.0:
        raise ValueError("no particles beside the crack faces")
    value = float(basis @ displacement) / square
    misfit = displacement - value * basis
    variance = float(misfit @ misfit) / max(basis.size - 1, 1)
    return StressIntensity(value, float(np.sqrt(variance / square)))


def _projected_release_rate(k1: float, k2: float, youngs_modulus: float) -> float:
    """G2 = (K_I² + K_II²)/E [J/m²], plane stress."""
    return (k1**2 + k2**2) / youngs_modulus


def propagated_release_rate(u0: float, u1: float, u2: float, spacing: float) -> float:
    """G1 = -(-3/2 U(a) + 2 U(a+Δx) - 1/2 U(a+2Δx))/Δx [J/m²] (3.24).

    Parameters
    ----------
    u0, u1, u2 : float
        Strain energies U with the crack's length and one and two spacings more (J/m).
    spacing : float
        Δx (m).
    """
    return -(-1.5 * u0 + 2.0 * u1 - 0.5 * u2) / spacing


def _projection(run: xr.Dataset, config, chosen: np.ndarray) -> tuple[StressIntensity, ...]:
    """K_I and K_II from the chosen particles, in the settled state with crack length a."""
    state, scene = snapshot(run, "settle"), config.scene
    x0, y0 = (run[f"reference_{axis}"].values[chosen] for axis in "xy")
    u_x = state["x"].values[chosen] - x0
    u_y = state["y"].values[chosen] - y0
    return (
        fit_stress_intensity(1, x0, y0, u_y, scene.E, scene.nu),
        fit_stress_intensity(2, x0, y0, u_x, scene.E, scene.nu),
    )


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Metrics of the cracked square (thesis 3.3)."""
    scene = config.scene
    exact = williams.energy_release_rate(scene.K, scene.E)
    faces = run["tag_faces"].values == 1
    free = faces & (run["tag_frame"].values == 0)
    k1, k2 = _projection(run, config, faces)
    free_k1, free_k2 = _projection(run, config, free)
    g2 = _projected_release_rate(k1.value, k2.value, scene.E)
    free_g2 = _projected_release_rate(free_k1.value, free_k2.value, scene.E)
    k_exact = (scene.K, 0.0) if scene.mode == 1 else (0.0, scene.K)
    k_units, g_units = "Pa m0.5", "J m-2"
    metrics = {
        "G_exact": Metric(exact, g_units, "energy release rate K²/E"),
        "G2": Metric(g2, g_units, "energy release rate by projection"),
        "G2_error": pure(g2 / exact - 1.0, "relative error of G2"),
        "G2_error_free": pure(free_g2 / exact - 1.0, "relative error of G2 from free particles only"),
        "K_I": Metric(k1.value, k_units, "K_I from u_y of the crack faces"),
        "K_I_standard_error": Metric(k1.standard_error, k_units, "standard error of that fit"),
        "K_I_error": pure((k1.value - k_exact[0]) / scene.K, "error of K_I over K"),
        "K_II": Metric(k2.value, k_units, "K_II from u_x of the crack faces"),
        "K_II_standard_error": Metric(k2.standard_error, k_units, "standard error of that fit"),
        "K_II_error": pure((k2.value - k_exact[1]) / scene.K, "error of K_II over K"),
    }
    stages = ("settle", *(f"extend{k}" for k in range(1, scene.extensions + 1)))
    states = [snapshot(run, stage) for stage in stages]
    energies = [float(state["snapshot_strain_energy"]) for state in states]
    for k, energy in enumerate(energies):
        length = "a" if k == 0 else f"a + {k}Δx"
        metrics[f"U{k}"] = Metric(energy, "J m-1", f"strain energy with crack length {length}")
    if len(energies) == 3:
        u0, u1, u2 = energies
        spacing = float(run["spacing_x"])
        g1 = propagated_release_rate(u0, u1, u2, spacing)
        metrics["G1"] = Metric(g1, g_units, "energy release rate by propagation (3.24)")
        metrics["G1_error"] = pure(g1 / exact - 1.0, "relative error of G1")
        first, second = (float(state["snapshot_closure_work"]) for state in states[1:])
        if np.isfinite(first + second):
            closure = propagated_release_rate(0.0, -first, -first - second, spacing)
            metrics["G_closure"] = Metric(
                closure, g_units, "energy release rate by virtual crack closure"
            )
            metrics["G_closure_error"] = pure(closure / exact - 1.0, "relative error of G_closure")
    return metrics
