"""Constitutive laws of total Lagrangian methods: energy density, first Piola–Kirchhoff stress, tangent.

All are isotropic, agree with Hooke's law at small strain, and come in plane strain and plane stress. A
2 × 2 tensor is written as its components xx, xy, yx, yy: the first index is that of the current, the
second that of the reference configuration.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.model.material import Material
from sphstudy.numerics.compilation import compiled, compiled_inner

LAWS = ("linear", "svk", "neohookean")
"""Linear Hooke; St Venant–Kirchhoff; compressible neo-Hookean ψ = µ/2 (I₁ - 3) - µ ln J + λ/2 ln² J."""

THICKNESS_ITERATIONS = 30
"""Newton steps at most for the stretch through the thickness; it converges quadratically."""


class Law(NamedTuple):
    """A law and its moduli (Pa). Compiled code is specialised by which optional fields are None.

    lame, shear: λ of the stress in the plane (in plane stress λE of Hooke's law there) and µ, except for
    the neo-Hookean law in plane stress, whose λ is the solid's own and whose stretch through the
    thickness is found from σ_zz = 0 (`thins`).
    """

    lame: float
    shear: float
    svk: bool | None = None
    neohookean: bool | None = None
    thins: bool | None = None

    @property
    def objective(self) -> bool:
        """Whether the energy is unchanged by rotations of any size."""
        return self.svk is not None or self.neohookean is not None


def law(name: str, material: Material) -> Law:
    """The law of that name (one of LAWS) for a material."""
    shear, lame = material.shear_modulus, material.lame_modulus
    if name == "linear":
        return Law(lame, shear)
    if name == "svk":
        return Law(lame, shear, svk=True)
    if material.plane == "strain":
        return Law(lame, shear, neohookean=True)
    return Law(material.bulk_modulus - 2.0 * shear / 3.0, shear, neohookean=True, thins=True)


@compiled_inner
def _thickness(thins, lame, shear, log_area):
    """ln of the stretch through the thickness: µ (t² - 1) + λ (ln J₂ + ln t) = 0; 0 in plane strain."""
    s = 0.0
    if thins is None:
        return s
    for _ in range(THICKNESS_ITERATIONS):
        squared = np.exp(2.0 * s)
        step = (shear * (squared - 1.0) + lame * (log_area + s)) / (2.0 * shear * squared + lame)
        s -= step
        if abs(step) < 1e-15:
            break
    return s


@compiled_inner
def _stress(svk, neohookean, thins, lame, shear, xx, xy, yx, yy):
    if svk is not None:
        e_xx = 0.5 * (xx * xx + yx * yx - 1.0)
        e_yy = 0.5 * (xy * xy + yy * yy - 1.0)
        e_xy = 0.5 * (xx * xy + yx * yy)
        mean = lame * (e_xx + e_yy)
        s_xx, s_yy, s_xy = mean + 2.0 * shear * e_xx, mean + 2.0 * shear * e_yy, 2.0 * shear * e_xy
        return (
            xx * s_xx + xy * s_xy,
            xx * s_xy + xy * s_yy,
            yx * s_xx + yy * s_xy,
            yx * s_xy + yy * s_yy,
        )
    if neohookean is not None:
        area = xx * yy - xy * yx
        log_area = np.log(area)
        log_volume = log_area + _thickness(thins, lame, shear, log_area)
        inverse = (lame * log_volume - shear) / area
        return (
            shear * xx + inverse * yy,
            shear * xy - inverse * yx,
            shear * yx - inverse * xy,
            shear * yy + inverse * xx,
        )
    mean = lame * (xx - 1.0 + yy - 1.0)
    shearing = shear * (xy + yx)
    return mean + 2.0 * shear * (xx - 1.0), shearing, shearing, mean + 2.0 * shear * (yy - 1.0)


@compiled
def stress(law, xx, xy, yx, yy):
    """First Piola–Kirchhoff stress P [Pa] of the deformation gradient F, component by component.

    The neo-Hookean law gives no finite stress where det F ≤ 0.
    """
    return _stress(law.svk, law.neohookean, law.thins, law.lame, law.shear, xx, xy, yx, yy)


@compiled_inner
def _energy(svk, neohookean, thins, lame, shear, xx, xy, yx, yy):
    e_xx, e_yy, e_xy = xx - 1.0, yy - 1.0, 0.5 * (xy + yx)
    if neohookean is not None:
        # I₁ - 3 and J - 1 from the displacement gradient: from F, small strains would drown in rounding.
        trace = e_xx + e_yy
        log_area = np.log1p(trace + e_xx * e_yy - xy * yx)
        s = _thickness(thins, lame, shear, log_area)
        log_volume = log_area + s
        first = 2.0 * trace + e_xx * e_xx + e_yy * e_yy + xy * xy + yx * yx + np.expm1(2.0 * s)
        return 0.5 * shear * first - shear * log_volume + 0.5 * lame * log_volume * log_volume
    if svk is not None:
        e_xx = 0.5 * (xx * xx + yx * yx - 1.0)
        e_yy = 0.5 * (xy * xy + yy * yy - 1.0)
        e_xy = 0.5 * (xx * xy + yx * yy)
    trace = e_xx + e_yy
    return 0.5 * lame * trace * trace + shear * (e_xx * e_xx + e_yy * e_yy + 2.0 * e_xy * e_xy)


@compiled
def energy_density(law, xx, xy, yx, yy):
    """Strain energy per reference volume ψ [J/m³] of the deformation gradient F; ψ(I) = 0."""
    return _energy(law.svk, law.neohookean, law.thins, law.lame, law.shear, xx, xy, yx, yy)


@compiled
def stresses(law, gradient):
    """P [4, N] (Pa) at the deformation gradients F [4, N]."""
    found = np.empty_like(gradient)
    for i in range(gradient.shape[1]):
        found[0, i], found[1, i], found[2, i], found[3, i] = stress(
            law, gradient[0, i], gradient[1, i], gradient[2, i], gradient[3, i]
        )
    return found


@compiled
def energy_densities(law, gradient):
    """ψ [N] (J/m³) at the deformation gradients F [4, N]."""
    found = np.empty(gradient.shape[1])
    for i in range(gradient.shape[1]):
        found[i] = energy_density(law, gradient[0, i], gradient[1, i], gradient[2, i], gradient[3, i])
    return found


def tangent(law: Law, gradient: np.ndarray) -> np.ndarray:
    """∂P_ab/∂F_cd [2, 2, 2, 2, N] (Pa) at the deformation gradients F [4, N]."""
    unit = np.eye(2)
    if not law.objective:
        constant = (
            law.lame * np.einsum("ab,cd->abcd", unit, unit)
            + law.shear * np.einsum("ac,bd->abcd", unit, unit)
            + law.shear * np.einsum("ad,bc->abcd", unit, unit)
        )
        return np.repeat(constant[..., None], gradient.shape[1], axis=-1)
    f = gradient.reshape(2, 2, -1)
    if law.svk:
        strain = 0.5 * (np.einsum("ean,ebn->abn", f, f) - unit[..., None])
        second = law.lame * np.einsum("ab,ccn->abn", unit, strain) + 2.0 * law.shear * strain
        return (
            np.einsum("ac,bdn->abcdn", unit, second)
            + law.lame * np.einsum("abn,cdn->abcdn", f, f)
            + law.shear * np.einsum("adn,cbn->abcdn", f, f)
            + law.shear * np.einsum("aen,cen,bd->abcdn", f, f, unit)
        )
    area = f[0, 0] * f[1, 1] - f[0, 1] * f[1, 0]
    turned = np.array([[f[1, 1], -f[1, 0]], [-f[0, 1], f[0, 0]]]) / area
    log_area = np.log(area)
    log_thickness, stiffness = np.zeros_like(area), np.full_like(area, law.lame)
    if law.thins:
        log_thickness = _thicknesses(law, log_area)
        resistance = 2.0 * law.shear * np.exp(2.0 * log_thickness)
        stiffness = law.lame * resistance / (resistance + law.lame)
    against = law.shear - law.lame * (log_area + log_thickness)
    return (
        law.shear * np.einsum("ac,bd,n->abcdn", unit, unit, np.ones_like(area))
        + np.einsum("n,adn,cbn->abcdn", against, turned, turned)
        + np.einsum("n,abn,cdn->abcdn", stiffness, turned, turned)
    )


@compiled
def _thicknesses(law, log_area):
    found = np.empty_like(log_area)
    for i in range(log_area.size):
        found[i] = _thickness(law.thins, law.lame, law.shear, log_area[i])
    return found
