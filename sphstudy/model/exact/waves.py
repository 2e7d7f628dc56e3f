"""Plane waves of linear elasticity: their speed, a stopped bar, the stiffness of the shortest ones."""

import numpy as np
from scipy import special

from sphstudy.model.material import Material


def longitudinal_speed(material: Material) -> float:
    """c = √((λ + 2µ)/ρ) [m/s], with the λ of the stress in the plane."""
    modulus = material.lame_modulus + 2.0 * material.shear_modulus
    return float(np.sqrt(modulus / material.density))


def stopped_bar(
    x: np.ndarray, time: float, speed: float, material: Material
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """State along a bar whose end is stopped.

    Until time = 0 all of x > 0 flies towards the wall at x = 0. By d'Alembert a front leaves the wall
    with c; behind it nothing moves and σ_xx = -ρ c speed.

    Parameters
    ----------
    x : array [N]
        Distances from the wall, not negative (m).
    time : float
        Time since the bar was stopped (s).
    speed : float
        Its speed before (m/s).
    material : Material
        The bar's.

    Returns
    -------
    tuple of array [N]
        Displacement (m), velocity (m/s) and σ_xx (Pa).
    """
    sound = longitudinal_speed(material)
    behind = x < sound * time
    displacement = -speed * np.minimum(time, x / sound)
    velocity = np.where(behind, 0.0, -speed)
    stress = np.where(behind, -material.density * sound * speed, 0.0)
    return displacement, velocity, stress


def checkerboard_stiffness(material: Material) -> float:
    """(λ + 3µ) π² [Pa]: force per displacement and thickness on a particle of a square lattice, in the
    solid that it stands for, if displacements are the plane wave that alternates along rows and columns.

    With k = (π, π)/Δ and displacements along x, the acoustic tensor gives ρ ω² = (λ + µ) k_x² + µ k²; the
    particle's mass is ρ Δ², so that Δ drops out. (Such a wave is no eigenmode: it pulls along y as well.)
    """
    return (material.lame_modulus + 3.0 * material.shear_modulus) * float(np.pi**2)


def stopped_chain(index: np.ndarray, phase: float) -> np.ndarray:
    """Velocities [N] over the bar's speed, from 0 to about -1, of a chain of equal masses and springs.

    It is the bar of `stopped_bar` as the plainest lattice has it, without dissipation. Mass number 0 is
    stopped; index [N] ≥ 0: numbers of masses; phase = c time/spacing. Schrödinger's Bessel functions
    (1914) of the odd continuation sum up to -(J_0 + 2 Σ_{0<k<n} J_2k + J_2n)(2 phase).
    The front widens as ∛phase, and
    behind it the velocity overshoots by what the integral of Airy's function does, 0.274.
    """
    terms = special.jv(2 * np.arange(int(index.max()) + 1), 2.0 * phase)
    sums = 2.0 * np.cumsum(terms) - terms[0]
    return (terms - sums)[index]
