"""Stress intensities and J of a crack by domain integrals over an annulus of particles.

Integrals along a contour become integrals over an area with a weight q that falls from one to zero across
the annulus (Li, Shih & Needleman 1985; Moran & Shih 1987). From the energy–momentum tensor b, whose
divergence vanishes in equilibrium,

    J = ∫ b_1j q,j dA,   b_1j = P_ij u_i,1 - ψ δ_1j.

Of J of the sum of the field and an auxiliary one, what is bilinear in both is their interaction, which
tells the modes apart (Yau, Wang & Corten 1980):

    I = ∫ (P_ij u'_i,1 + σ'_ij u_i,1 - P_ik ε'_ik δ_1j) q,j dA = 2 (K_I K'_I + K_II K'_II) / E.

Plane stress, no body forces; reference configuration; free crack faces on y = 0, x < tip_x. J holds for
any stored energy, the stress intensities for small strain. Tensors are [4, M]: xx, xy, yx, yy, where
H_xy = ∂u_x/∂Y.

The sums are midpoint rules on a lattice whose rows keep half a spacing from the crack. Across the annulus
they are as good as q is smooth. Across the crack too, since products of two fields in √r are the same on
both faces. The product with a T-stress (r⁰) is not: it breaks off there, an error of second order in the
spacing. With twenty spacings along a crack of length a, T = K_I/√(πa) changes K_I by 7e-5.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.model.exact import williams

ROUNDING = 1e-9
"""Relative: an annulus that touches a limit fits, whichever way the limit was rounded."""


class Annulus(NamedTuple):
    """Ring about the crack tip, from its inner to its outer radius (m)."""

    inner: float
    outer: float


def fits(annulus: Annulus, clearance: float, edge: float) -> str:
    """Why an annulus cannot be used, in one sentence; "" if it can.

    Parameters
    ----------
    annulus : Annulus
        The annulus.
    clearance : float
        Radius of the kernel's support (m): a particle nearer to the tip has the tip inside its support.
    edge : float
        Distance from the tip to the cell of the nearest driven particle (m).
    """
    inner, outer = annulus
    if not outer > inner:
        return f"outer radius {outer:g} m: must be greater than the inner radius, {inner:g} m"
    if not inner >= clearance * (1.0 - ROUNDING):
        return f"inner radius {inner:g} m: must be at least {clearance:g} m, or particles see the tip"
    if not outer <= edge * (1.0 + ROUNDING):
        return f"outer radius {outer:g} m: must be at most {edge:g} m, where particles are driven"
    return ""


def weight_gradient(
    x: np.ndarray, y: np.ndarray, annulus: Annulus, tip_x: float
) -> tuple[np.ndarray, np.ndarray]:
    """Gradient of the weight q, zero outside the annulus.

    q is one minus the smoothstep of ninth order, of slope 630 s⁴ (1-s)⁴ with s from 0 to 1 across the
    annulus. The more derivatives vanish at its ends the better the quadrature, until the slope becomes
    too narrow. Largest relative error left in K by annuli from 12 (6) spacings wide upwards: fifth order
    7e-5 (7e-4), seventh 2e-5 (3e-4), ninth 3e-6 (1e-4), bump exp(-1/(s(1-s))) 8e-6 (6e-4).

    Parameters
    ----------
    x, y : array [M]
        Reference positions (m).
    annulus : Annulus
        Where q falls from one to zero.
    tip_x : float
        x of the tip (m), whose y is 0.

    Returns
    -------
    tuple of array [M]
        ∂q/∂x and ∂q/∂y (1/m).
    """
    r = np.hypot(x - tip_x, y)
    width = annulus.outer - annulus.inner
    s = np.clip((r - annulus.inner) / width, 0.0, 1.0)
    slope = -630.0 * (s * (1.0 - s)) ** 4 / width
    over_r = slope / np.where(r > 0.0, r, 1.0)
    return over_r * (x - tip_x), over_r * y


def stress_intensities(
    x: np.ndarray,
    y: np.ndarray,
    volume: np.ndarray,
    P: np.ndarray,
    H: np.ndarray,
    annulus: Annulus,
    tip_x: float,
    E: float,
    nu: float,
) -> tuple[float, float]:
    """K_I and K_II by interaction integrals with Williams' modes of K = 1 Pa √m.

    Parameters
    ----------
    x, y : array [M]
        Reference positions (m).
    volume : array [M]
        Areas of the particles in the reference configuration (m²).
    P : array [4, M]
        First Piola–Kirchhoff stress (Pa).
    H : array [4, M]
        Displacement gradient.
    annulus : Annulus
        Where the integrals are taken.
    tip_x : float
        x of the tip (m), whose y is 0.
    E, nu : float
        Young's modulus (Pa) and Poisson's ratio.

    Returns
    -------
    tuple of float
        K_I and K_II (Pa √m).

    Raises
    ------
    ValueError
        If there are no particles in the annulus.
    """
    chosen = _particles_in(annulus, x, y, tip_x)
    x, y, volume, P, H = x[chosen], y[chosen], volume[chosen], P[:, chosen], H[:, chosen]
    slopes = weight_gradient(x, y, annulus, tip_x)
    first, second = (
        0.5 * E * _weighted(volume, _interaction(P, H, *_auxiliary(mode, x - tip_x, y, E, nu)), slopes)
        for mode in (1, 2)
    )
    return first, second


def j_integral(
    x: np.ndarray,
    y: np.ndarray,
    volume: np.ndarray,
    P: np.ndarray,
    H: np.ndarray,
    psi: np.ndarray,
    annulus: Annulus,
    tip_x: float,
) -> float:
    """J, which is (K_I² + K_II²)/E under small strain.

    Parameters
    ----------
    x, y, volume, P, H, annulus, tip_x
        As those of `stress_intensities`.
    psi : array [M]
        Stored energy per reference volume (J/m³).

    Returns
    -------
    float
        J (J/m²).

    Raises
    ------
    ValueError
        If there are no particles in the annulus.
    """
    chosen = _particles_in(annulus, x, y, tip_x)
    along, across = _work(P[:, chosen], H[:, chosen])
    slopes = weight_gradient(x[chosen], y[chosen], annulus, tip_x)
    return _weighted(volume[chosen], (along - psi[chosen], across), slopes)


def _particles_in(annulus: Annulus, x: np.ndarray, y: np.ndarray, tip_x: float) -> np.ndarray:
    """Mask [M]. Values outside may be infinite, as at the tip: they must not be multiplied by zero."""
    r = np.hypot(x - tip_x, y)
    chosen = (annulus.inner < r) & (r < annulus.outer)
    if not chosen.any():
        raise ValueError(f"no particles between {annulus.inner:g} m and {annulus.outer:g} m from the tip")
    return chosen


def _auxiliary(
    mode: int, x: np.ndarray, y: np.ndarray, E: float, nu: float
) -> tuple[np.ndarray, np.ndarray]:
    """Stress and displacement gradient [4, M] of Williams' field with K = 1 Pa √m."""
    xx, yy, xy = williams.stress(mode, x, y, 1.0)
    return np.stack([xx, xy, xy, yy]), np.stack(williams.displacement_gradient(mode, x, y, 1.0, E, nu))


def _work(P: np.ndarray, H: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """P_ij H_i1 for j = 1 and 2."""
    return P[0] * H[0] + P[2] * H[2], P[1] * H[0] + P[3] * H[2]


def _interaction(
    P: np.ndarray, H: np.ndarray, auxiliary_stress: np.ndarray, auxiliary_gradient: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """What is bilinear in the energy–momentum tensor, for j = 1 and 2."""
    along, across = _work(P, auxiliary_gradient)
    auxiliary_along, auxiliary_across = _work(auxiliary_stress, H)
    u_xx, u_xy, u_yx, u_yy = auxiliary_gradient
    mutual = P[0] * u_xx + (P[1] + P[2]) * 0.5 * (u_xy + u_yx) + P[3] * u_yy
    return along + auxiliary_along - mutual, across + auxiliary_across


def _weighted(
    volume: np.ndarray, tensor: tuple[np.ndarray, np.ndarray], slopes: tuple[np.ndarray, np.ndarray]
) -> float:
    """Σ V b_1j q,j."""
    return float(np.sum(volume * (tensor[0] * slopes[0] + tensor[1] * slopes[1])))
