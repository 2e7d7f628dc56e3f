"""Williams' field of a crack tip in plane stress, modes I and II (thesis 3.6 to 3.17).

Crack on the negative x axis, tip at the origin. Two signs of mode II that the thesis prints wrongly (u_y,
σ_xx) are those that satisfy Hooke's law and equilibrium.
"""

import numpy as np


def displacement(
    mode: int,
    x: np.ndarray,
    y: np.ndarray,
    stress_intensity: float,
    youngs_modulus: float,
    poisson_ratio: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Displacement of the field.

    Parameters
    ----------
    mode : {1, 2}
        1: opening; 2: sliding.
    x, y : array [N]
        Positions with respect to the tip (m).
    stress_intensity : float
        K of the mode (Pa √m).
    youngs_modulus, poisson_ratio : float
        E (Pa) and ν.

    Returns
    -------
    tuple of array [N]
        u_x and u_y (m).

    Raises
    ------
    ValueError
        If there is no such mode.
    """
    half = 0.5 * np.arctan2(y, x)
    kappa = (3.0 - poisson_ratio) / (1.0 + poisson_ratio)
    scale = (1.0 + poisson_ratio) * stress_intensity / (4.0 * np.pi * youngs_modulus)
    scale = scale * np.sqrt(2.0 * np.pi * np.hypot(x, y))
    if mode == 1:
        return (
            scale * ((2.0 * kappa - 1.0) * np.cos(half) - np.cos(3.0 * half)),
            scale * ((2.0 * kappa + 1.0) * np.sin(half) - np.sin(3.0 * half)),
        )
    if mode == 2:
        return (
            scale * ((2.0 * kappa + 3.0) * np.sin(half) + np.sin(3.0 * half)),
            -scale * ((2.0 * kappa - 3.0) * np.cos(half) + np.cos(3.0 * half)),
        )
    raise ValueError(f"mode {mode}: must be 1 or 2")


def stress(
    mode: int, x: np.ndarray, y: np.ndarray, stress_intensity: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """σ_xx, σ_yy and σ_xy [N] (Pa); arguments as of `displacement`."""
    half = 0.5 * np.arctan2(y, x)
    scale = stress_intensity / np.sqrt(2.0 * np.pi * np.hypot(x, y))
    sine, cosine = np.sin(half), np.cos(half)
    if mode == 1:
        return (
            scale * cosine * (1.0 - sine * np.sin(3.0 * half)),
            scale * cosine * (1.0 + sine * np.sin(3.0 * half)),
            scale * cosine * sine * np.cos(3.0 * half),
        )
    if mode == 2:
        return (
            -scale * sine * (2.0 + cosine * np.cos(3.0 * half)),
            scale * sine * cosine * np.cos(3.0 * half),
            scale * cosine * (1.0 - sine * np.sin(3.0 * half)),
        )
    raise ValueError(f"mode {mode}: must be 1 or 2")


def displacement_gradient(
    mode: int,
    x: np.ndarray,
    y: np.ndarray,
    stress_intensity: float,
    youngs_modulus: float,
    poisson_ratio: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """∂u_x/∂x, ∂u_x/∂y, ∂u_y/∂x and ∂u_y/∂y [N]; arguments as of `displacement`.

    Strain by Hooke's law. Rotation: E ω is the harmonic conjugate of σ_xx + σ_yy, for in Muskhelishvili's
    φ(z) the latter is 4 Re φ' and the former, in plane stress, 4 Im φ'; in mode I 4φ' = 2K/√(2πz), in
    mode II -2iK/√(2πz).
    """
    xx, yy, xy = stress(mode, x, y, stress_intensity)
    half = 0.5 * np.arctan2(y, x)
    scale = -2.0 * stress_intensity / np.sqrt(2.0 * np.pi * np.hypot(x, y))
    rotation = scale * (np.sin(half) if mode == 1 else np.cos(half)) / youngs_modulus
    shear = (1.0 + poisson_ratio) * xy / youngs_modulus
    return (
        (xx - poisson_ratio * yy) / youngs_modulus,
        shear - rotation,
        shear + rotation,
        (yy - poisson_ratio * xx) / youngs_modulus,
    )


def energy_release_rate(stress_intensity: float, youngs_modulus: float) -> float:
    """G = K²/E [J/m²] in plane stress."""
    return stress_intensity**2 / youngs_modulus
