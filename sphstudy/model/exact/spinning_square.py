"""Elastic square that rotates steadily: how far centrifugal force extends it, at small strain.

Ritz's method with Legendre polynomials. By symmetry u_x is odd in x and even in y, and u_y(x, y) =
u_x(y, x). A reference is the value at the higher of two degrees, its error estimate their difference.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from sphstudy.model.exact.elasticity2d import Reference
from sphstudy.model.material import Material

_TERMS = (6, 9)
"""Polynomials in each direction."""


class Spinning(NamedTuple):
    """Relative gains of a corner's distance to the centre and of the moment of inertia."""

    corner_stretch: Reference
    inertia_gain: Reference


@lru_cache
def spinning_square(side: float, rate: float, material: Material) -> Spinning:
    """A square that rotates steadily, to first order in ρ rate² side²/µ; side (m), rate (rad/s)."""
    coarse, fine = (_solved(side, rate, material, terms) for terms in _TERMS)
    return Spinning(*(Reference(b, abs(b - a)) for a, b in zip(coarse, fine, strict=True)))


def _solved(side: float, rate: float, material: Material, terms: int) -> tuple[float, float]:
    half = 0.5 * side
    at, weight = legendre.leggauss(2 * terms + 2)
    even, odd = np.arange(terms) * 2, np.arange(terms) * 2 + 1

    def values(degrees: np.ndarray, order: int) -> np.ndarray:
        """Polynomials [terms, points], or their derivatives in the plane's unit."""
        columns = np.eye(2 * terms)[degrees]
        return np.array([legendre.legval(at, legendre.legder(c, order)) for c in columns]) / half**order

    def products(x_part: np.ndarray, y_part: np.ndarray) -> np.ndarray:
        """Products [terms², points²], the point's x first."""
        return np.einsum("ap,bq->abpq", x_part, y_part).reshape(terms**2, -1)

    area = np.outer(weight, weight).ravel() * half**2
    along = products(values(odd, 1), values(even, 0))  # ∂u_x/∂x
    across = products(values(odd, 0), values(even, 1))  # ∂u_x/∂y
    swapped = np.arange(at.size**2).reshape(at.size, at.size).T.ravel()
    strains = (along, along[:, swapped], 0.5 * (across + across[:, swapped]))
    lame, shear = material.lame_modulus, material.shear_modulus
    trace = strains[0] + strains[1]
    stiffness = lame * (trace * area) @ trace.T
    for strain, times in zip(strains, (1.0, 1.0, 2.0), strict=True):
        stiffness += 2.0 * shear * times * (strain * area) @ strain.T
    moved = products(values(odd, 0), values(even, 0))
    x = np.repeat(half * at, at.size)
    # x u_x + y u_y, of which the second is the first with x and y exchanged.
    outward = 2.0 * moved @ (area * x)
    shape = np.linalg.solve(stiffness, material.density * rate**2 * outward)
    # All Legendre polynomials are 1 at the corner.
    return float(shape.sum()) / half, 2.0 * float(outward @ shape) / (side**4 / 6.0)
