"""The cubic spline kernel in two dimensions (2.7), as functions of q = r/h.

Written with truncated powers, W ∝ (2-q)³₊ - 4 (1-q)³₊: the same polynomial pieces as the thesis
prints, without a branch, so that loops over pairs vectorise.
"""

import math

from sphstudy.compilation import compiled

SUPPORT = 2.0
"""Radius of the support in units of the smoothing length h."""


def normalisation(smoothing_length: float) -> float:
    """α_k = 15/(7π h²) [1/m²], which makes the kernel integrate to one in the plane."""
    return 15.0 / (7.0 * math.pi * smoothing_length**2)


@compiled
def value(q):
    """W/α_k: 2/3 - q² + q³/2 up to q = 1, (2-q)³/6 up to 2, then zero."""
    outer = max(2.0 - q, 0.0)
    inner = max(1.0 - q, 0.0)
    return (outer * outer * outer - 4.0 * inner * inner * inner) / 6.0


@compiled
def slope(q):
    """(dW/dq)/α_k: -2q + 3q²/2 up to q = 1, -(2-q)²/2 up to 2, then zero."""
    outer = max(2.0 - q, 0.0)
    inner = max(1.0 - q, 0.0)
    return 2.0 * inner * inner - 0.5 * outer * outer
