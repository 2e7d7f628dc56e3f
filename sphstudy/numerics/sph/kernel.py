"""Smoothing kernels in two dimensions, as functions of q = r/h: value, slope and curvature.

The splines are written with truncated powers, such as W ∝ (2-q)³₊ - 4 (1-q)³₊ for the cubic one: the
same polynomial pieces as in the books, without a branch, so that loops over pairs vectorise.
"""

import math
from typing import NamedTuple

from sphstudy.numerics.compilation import compiled, compiled_inner


class Kernel(NamedTuple):
    """A kernel. Compiled code is specialised by which of the last two fields is None.

    support: radius in units of the smoothing length h; scale: h² α, with W = α · value(q).
    """

    support: float
    scale: float
    wendland: bool | None = None
    quintic: bool | None = None

    def normalisation(self, smoothing_length: float) -> float:
        """α [1/m²], which makes the kernel integrate to one in the plane."""
        return self.scale / smoothing_length**2


KERNELS = {
    "cubic": Kernel(2.0, 15.0 / (7.0 * math.pi)),
    "wendland": Kernel(2.0, 7.0 / (4.0 * math.pi), wendland=True),
    "quintic": Kernel(3.0, 7.0 / (478.0 * math.pi), quintic=True),
}
"""Cubic spline (2.7); Wendland C2 (1 - q/2)⁴ (1 + 2q); quintic spline (Morris, Fox & Zhu 1997)."""


@compiled_inner
def _value(wendland, quintic, q):
    outer = max(2.0 - q, 0.0)
    if wendland is not None:
        squared = 0.25 * outer * outer
        return squared * squared * (1.0 + 2.0 * q)
    inner = max(1.0 - q, 0.0)
    if quintic is not None:
        outermost = max(3.0 - q, 0.0)
        return outermost**5 - 6.0 * outer**5 + 15.0 * inner**5
    return (outer * outer * outer - 4.0 * inner * inner * inner) / 6.0


@compiled
def value(kernel, q):
    """W/α. Cubic: 2/3 - q² + q³/2 up to q = 1, (2-q)³/6 up to 2, then zero."""
    return _value(kernel.wendland, kernel.quintic, q)


@compiled_inner
def _slope(wendland, quintic, q):
    outer = max(2.0 - q, 0.0)
    if wendland is not None:
        return -0.625 * q * outer * outer * outer
    inner = max(1.0 - q, 0.0)
    if quintic is not None:
        outermost = max(3.0 - q, 0.0)
        return -5.0 * outermost**4 + 30.0 * outer**4 - 75.0 * inner**4
    return 2.0 * inner * inner - 0.5 * outer * outer


@compiled
def slope(kernel, q):
    """(dW/dq)/α. Cubic: -2q + 3q²/2 up to q = 1, -(2-q)²/2 up to 2, then zero."""
    return _slope(kernel.wendland, kernel.quintic, q)


@compiled_inner
def _curvature(wendland, quintic, q):
    outer = max(2.0 - q, 0.0)
    if wendland is not None:
        return outer * outer * (2.5 * q - 1.25)
    inner = max(1.0 - q, 0.0)
    if quintic is not None:
        outermost = max(3.0 - q, 0.0)
        return 20.0 * outermost**3 - 120.0 * outer**3 + 300.0 * inner**3
    return outer - 4.0 * inner


@compiled
def curvature(kernel, q):
    """(d²W/dq²)/α, whose sign at the nearest neighbour decides about stability: a pair is unstable in
    tension where it is positive and in compression where it is negative (Swegle, Hicks & Attaway 1995).
    """
    return _curvature(kernel.wendland, kernel.quintic, q)
