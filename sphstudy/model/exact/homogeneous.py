"""Homogeneous states of plane strain: a bar in uniaxial, a disc in equibiaxial stress, law by law.

Laws are "linear" (Hooke, no difference between configurations), "svk" (St Venant–Kirchhoff), "neohookean"
(ψ = µ/2 (I₁ - 3) - µ ln J + λ/2 ln² J) and "rate": dσ/dt = λ tr(d) I + 2µ d with the current velocity
gradient, Hooke's law of the logarithmic strain as long as the principal axes do not turn. Stresses are
Cauchy's.
"""

import numpy as np
from scipy.optimize import brentq

from sphstudy.model.material import Material


def lateral_stretch(law: str, material: Material, strain: float) -> float:
    """Stretch across a bar that is free of stress across.

    Parameters
    ----------
    law : {"linear", "svk", "neohookean", "rate"}
        Relation of stress and strain, see the module.
    material : Material
        λ and µ of the plane.
    strain : float
        Elongation over length.

    Raises
    ------
    ValueError
        If there is no such law.
    """
    lame, shear = material.lame_modulus, material.shear_modulus
    contraction = lame / (lame + 2.0 * shear)
    stretch = 1.0 + strain
    if law == "linear":
        return 1.0 - contraction * strain
    if law == "svk":
        return float(np.sqrt(1.0 - contraction * (stretch**2 - 1.0)))
    if law == "rate":
        return float(stretch**-contraction)
    if law == "neohookean":
        # µ (b² - 1) + λ ln(a b) = 0 for b = exp(s): it grows with s, and has other signs at b = 1 and at
        # J = 1.
        def across(s: float) -> float:
            return shear * np.expm1(2.0 * s) + lame * (np.log(stretch) + s)

        ends = sorted((-np.log(stretch), 0.0))
        return float(np.exp(brentq(across, *ends, xtol=1e-15))) if strain else 1.0
    raise ValueError(_unknown(law))


def uniaxial_stress(law: str, material: Material, strain: float) -> float:
    """σ_xx [Pa] of a bar elongated in x and free of stress in y; arguments as of `lateral_stretch`."""
    lame, shear = material.lame_modulus, material.shear_modulus
    along, across = 1.0 + strain, lateral_stretch(law, material, strain)
    modulus = 4.0 * shear * (lame + shear) / (lame + 2.0 * shear)
    if law == "linear":
        return modulus * strain
    if law == "svk":
        return modulus * 0.5 * (along**2 - 1.0) * along / across
    if law == "rate":
        return float(modulus * np.log(along))
    return float((shear * (along**2 - 1.0) + lame * np.log(along * across)) / (along * across))


def equibiaxial_stress(law: str, material: Material, strain: float) -> float:
    """σ_xx = σ_yy [Pa] of a body elongated alike in all directions; arguments as of `lateral_stretch`."""
    lame, shear = material.lame_modulus, material.shear_modulus
    stretch, modulus = 1.0 + strain, 2.0 * (lame + shear)
    if law == "linear":
        return modulus * strain
    if law == "svk":
        return modulus * 0.5 * (stretch**2 - 1.0)
    if law == "rate":
        return float(modulus * np.log(stretch))
    if law == "neohookean":
        return float((shear * (stretch**2 - 1.0) + 2.0 * lame * np.log(stretch)) / stretch**2)
    raise ValueError(_unknown(law))


def _unknown(law: str) -> str:
    return f"law {law}: must be linear, svk, neohookean or rate"
