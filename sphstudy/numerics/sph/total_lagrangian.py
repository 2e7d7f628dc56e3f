"""Total Lagrangian SPH, variational and without hourglass modes: energy and force.

With bonds of weight w_ij = V_i V_j (-W'(R)/R) and L_i = (Σ_j w_ij X_ij ⊗ X_ij)⁻¹,

    F_i = (Σ_j w_ij x_ij ⊗ X_ij) L_i                                  (Bonet & Lok 1999: least squares)
    U   = Σ_i V_i ψ(F_i) + ½ ζ µ Σ_i Σ_j w_ij |x_ij - F_i X_ij|²       (the second: hourglass energy)
    f_i = -∂U/∂x_i = Σ_j w_ij [(A_i + A_j) X_ij + 2 ζ µ x_ij],  A_i = V_i P_i L_i - ζ µ F_i

so that linear and, with an objective law, angular momentum are kept to rounding. ζ = 1 makes the shear
part a Laplacian (Zhang, Wu & Hu 2024). Everything is per thickness.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.numerics.compilation import compiled
from sphstudy.numerics.sph import bond_sums, bonds, constitutive
from sphstudy.numerics.sph import contact as contacts
from sphstudy.numerics.sph.bonds import Bonds
from sphstudy.numerics.sph.constitutive import Law
from sphstudy.numerics.sph.contact import Contact, Surfaces
from sphstudy.numerics.sph.crack import Crack
from sphstudy.numerics.sph.hourglass import XX, XY, YX, YY, modulus
from sphstudy.numerics.sph.hourglass import energy as hourglass_energy
from sphstudy.numerics.sph.kernel import Kernel
from sphstudy.numerics.sph.viscosity import Viscosity

FLATTEST = 1e-10
"""Smallest ratio of det Σ w X⊗X to its trace squared: below, the neighbours lie on a line."""


class Model(NamedTuple):
    """Everything that energy and force need besides positions; optional terms are None.

    x, y [N]: reference positions (m); volume [N] (m²); mass [N] (kg/m); correction [3, N]: L, xx, xy, yy
    (1/m²); hourglass: ζµ (Pa); viscosity with its smoothing length (m) and wave speed (m/s); surfaces
    that may touch, and pairs of their particles that are close now.
    """

    x: np.ndarray
    y: np.ndarray
    volume: np.ndarray
    mass: np.ndarray
    bonds: Bonds
    correction: np.ndarray
    law: Law
    hourglass: float | None
    constraints: Constraints
    viscosity: Viscosity | None
    damping: float | None
    smoothing_length: float
    wave_speed: float
    surfaces: Surfaces | None = None
    contact: Contact | None = None


class Workspace(NamedTuple):
    """Arrays that evaluations reuse: deformation gradients F [4, N], A [4, N], terms of each thread.

    parallel: None on one thread, and then nothing is compiled for more.
    """

    gradient: np.ndarray
    flux: np.ndarray
    terms: np.ndarray
    parallel: bool | None


def model(
    x: np.ndarray,
    y: np.ndarray,
    mass: np.ndarray,
    density: float,
    shape: Kernel,
    smoothing_length: float,
    law: Law,
    constraints: Constraints,
    hourglass: float = 1.0,
    crack: Crack | None = None,
    viscous: Viscosity | None = None,
    damping: float = 0.0,
    wave_speed: float = np.inf,
    part: np.ndarray | None = None,
    surfaces: Surfaces | None = None,
) -> Model:
    """The model of particles at x, y [N] (m) with masses [N] (kg/m); `hourglass`: ζ; damping (1/s);
    part [N]: which of several bodies each belongs to.

    Raises ValueError where the neighbours of a particle do not determine its deformation gradient.
    """
    volume = mass / density
    found = bonds.build(x, y, volume, shape, smoothing_length, crack, part)
    return Model(
        x=x,
        y=y,
        volume=volume,
        mass=mass,
        bonds=found,
        correction=correction(found, x, y),
        law=law,
        hourglass=hourglass * law.shear if hourglass > 0.0 else None,
        constraints=constraints,
        viscosity=viscous,
        damping=damping or None,
        smoothing_length=smoothing_length,
        wave_speed=wave_speed,
        surfaces=surfaces,
        contact=surfaces.contact(x, y) if surfaces else None,
    )


def moments(bonded: Bonds, count: int) -> np.ndarray:
    """Σ_j w_ij X_ij ⊗ X_ij of each particle [3, N] (m²): xx, xy, yy."""
    first, second, weight, x, y = bonds.as_pairs(bonded)
    found = np.zeros((3, count))
    for row, product in enumerate((x * x, x * y, y * y)):
        for end in (first, second):
            found[row] += np.bincount(end, weight * product, minlength=count)
    return found


def correction(bonded: Bonds, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """L_i = (Σ_j w_ij X_ij ⊗ X_ij)⁻¹ [3, N] (1/m²): xx, xy, yy.

    Raises ValueError, naming the first particle, where the neighbours lie on a line or are missing.
    """
    xx, xy, yy = moments(bonded, x.size)
    determinant = xx * yy - xy * xy
    flat = np.flatnonzero(~(determinant > FLATTEST * (xx + yy) ** 2))
    if flat.size:
        i = flat[0]
        raise ValueError(
            f"{flat.size} particles without enough neighbours for a deformation gradient, "
            f"the first at ({x[i]:.4g}, {y[i]:.4g}) m"
        )
    return np.stack((yy, -xy, xx)) / determinant


def workspace(count: int, threads: int = 1) -> Workspace:
    """Workspace for `count` particles, summed by `threads` threads."""
    return Workspace(
        gradient=np.zeros((4, count)),
        flux=np.zeros((4, count)),
        terms=bond_sums.buffers(threads),
        parallel=True if threads > 1 else None,
    )


@compiled
def corrected_gradient(parallel, bonded, correction, x, y, gradient):
    """Σ_j w_ij x_ij ⊗ X_ij L_i [4, N] of the positions x, y [N] (m) into `gradient`."""
    bond_sums.moments(parallel, bonded, x, y, gradient)
    for i in range(x.size):
        l_xx, l_xy, l_yy = correction[0, i], correction[1, i], correction[2, i]
        xx, xy, yx, yy = gradient[XX, i], gradient[XY, i], gradient[YX, i], gradient[YY, i]
        gradient[XX, i] = xx * l_xx + xy * l_xy
        gradient[XY, i] = xx * l_xy + xy * l_yy
        gradient[YX, i] = yx * l_xx + yy * l_xy
        gradient[YY, i] = yx * l_xy + yy * l_yy


@compiled
def deformation_gradient(parallel, model, x, y, gradient):
    """F_i [4, N] of the positions x, y [N] (m) into `gradient`; exact where the motion is affine."""
    corrected_gradient(parallel, model.bonds, model.correction, x, y, gradient)


@compiled
def _fluxes(model, work):
    """A_i = V_i P_i L_i - ζ µ F_i from the deformation gradients."""
    gradient, flux = work.gradient, work.flux
    stiffness = modulus(model.hourglass)
    for i in range(gradient.shape[1]):
        xx, xy, yx, yy = gradient[XX, i], gradient[XY, i], gradient[YX, i], gradient[YY, i]
        p_xx, p_xy, p_yx, p_yy = constitutive.stress(model.law, xx, xy, yx, yy)
        v = model.volume[i]
        l_xx, l_xy, l_yy = (
            v * model.correction[0, i],
            v * model.correction[1, i],
            v * model.correction[2, i],
        )
        flux[XX, i] = p_xx * l_xx + p_xy * l_xy - stiffness * xx
        flux[XY, i] = p_xx * l_xy + p_xy * l_yy - stiffness * xy
        flux[YX, i] = p_yx * l_xx + p_yy * l_xy - stiffness * yx
        flux[YY, i] = p_yx * l_xy + p_yy * l_yy - stiffness * yy


@compiled
def force(model, x, y, work, force):
    """f_i = -∂U/∂x_i [2, N] (N/m) at the positions x, y [N] (m) into `force`; leaves F in `work`."""
    deformation_gradient(work.parallel, model, x, y, work.gradient)
    _fluxes(model, work)
    bond_sums.forces(work.parallel, model.bonds, x, y, work.flux, model.hourglass, work.terms, force)
    contacts.add_forces(model.contact, x, y, force)


@compiled
def energies(model, x, y, work):
    """Σ V ψ(F), hourglass energy and energy of contact [J/m] at the positions x, y [N] (m); leaves F in
    `work`.
    """
    gradient = work.gradient
    deformation_gradient(work.parallel, model, x, y, gradient)
    strain = 0.0
    for i in range(x.size):
        strain += model.volume[i] * constitutive.energy_density(
            model.law, gradient[XX, i], gradient[XY, i], gradient[YX, i], gradient[YY, i]
        )
    kept = hourglass_energy(model.hourglass, model.bonds, gradient, x, y)
    return strain, kept, contacts.energy(model.contact, x, y)


@compiled
def inverted(law, gradient):
    """How many particles are turned inside out, det F ≤ 0; to the linear law that means nothing."""
    count = 0
    if law.svk is not None or law.neohookean is not None:
        for i in range(gradient.shape[1]):
            area = gradient[XX, i] * gradient[YY, i] - gradient[XY, i] * gradient[YX, i]
            count += not area > 0.0
    return count
