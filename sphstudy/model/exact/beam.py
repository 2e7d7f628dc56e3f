"""Euler–Bernoulli beam: the thesis's answers for the vibrating and the bending plate."""

import numpy as np

ROOT = 1.8751
"""α0, first root of cos α cosh α = -1, with the digits that the thesis prints."""


def fundamental_frequency(youngs_modulus: float, density: float, length: float, height: float) -> float:
    """ω0 = (α0/L)² D √(E/(12ρ)) of a clamped-free beam (3.1).

    Parameters
    ----------
    youngs_modulus, density : float
        E (Pa) and ρ (kg/m³).
    length, height : float
        L and full height D (m).

    Returns
    -------
    float
        Angular frequency (rad/s).
    """
    return (ROOT / length) ** 2 * height * np.sqrt(youngs_modulus / (12.0 * density))


def thin_plate_frequency(
    youngs_modulus: float, poisson_ratio: float, density: float, length: float, height: float
) -> float:
    """ω1 of a clamped-free thin plate in plane strain [rad/s]: as of a beam, with E/(1 - ν²) for E."""
    return fundamental_frequency(youngs_modulus / (1.0 - poisson_ratio**2), density, length, height)


def mode_shape(x: np.ndarray | float, length: float) -> np.ndarray:
    """Shape of the lowest clamped-free mode, 1 at x = length (3.2); x [N] (m)."""
    cosines = np.cos(ROOT) + np.cosh(ROOT)
    sines = np.sin(ROOT) + np.sinh(ROOT)

    def shape(position):
        s = ROOT / length * position
        return cosines * (np.sin(s) - np.sinh(s)) - sines * (np.cos(s) - np.cosh(s))

    return shape(np.asarray(x)) / shape(length)


def bent_centreline(x: np.ndarray, end_displacement: float, length: float, spacing: float) -> np.ndarray:
    """Deflection of a clamped beam whose last particles are moved (thesis 3.2).

    u_y(x) = u_p/(2β³) ((ξ-α)³ - 3β²(ξ-α) + 2β³), ξ = (L-x)/L, α = Δx/(2L), β = 1-α.

    Parameters
    ----------
    x : array [N]
        Where (m).
    end_displacement : float
        u_p of the last particles, at length - spacing/2 (m).
    length, spacing : float
        L and Δx (m).

    Returns
    -------
    array [N]
        u_y (m).
    """
    alpha = spacing / (2.0 * length)
    beta = 1.0 - alpha
    s = (length - np.asarray(x)) / length - alpha
    return end_displacement / (2.0 * beta**3) * (s**3 - 3.0 * beta**2 * s + 2.0 * beta**3)


def end_angle(end_displacement: float, length: float, spacing: float) -> float:
    """θ_end = 3 u_p/(2βL) [rad] at the driven end (thesis 3.2); arguments as of `bent_centreline`."""
    return 3.0 * end_displacement / (2.0 * (length - 0.5 * spacing))
