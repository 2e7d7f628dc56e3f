"""Artificial stress against tensile instability (2.25; Gray, Monaghan & Swift 2001).

The thesis scales it differently from Gray et al.: R = -ζσ, without the factor 1/ρ².
"""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled_inner
from sphstudy.numerics.sph import kernel


class ArtificialStress(NamedTuple):
    """ζ of (2.25), exponent n of f_ijⁿ (0 to 15), and W/α_k at the mean particle spacing."""

    fraction: float
    exponent: int
    kernel_at_spacing: float


@compiled_inner
def principal_pressure(artificial, xx, yy, xy):
    """R [Pa] of one particle: -ζ times the tensile part of its stress, xx, yy, xy.

    The thesis rotates by θ = ½ atan2(2σ_xy, σ_xx - σ_yy) to principal axes and back; with
    cos 2θ = (σ_xx - σ_yy)/2r, sin 2θ = σ_xy/r, r the radius of Mohr's circle, no angle is needed.
    """
    mean = 0.5 * (xx + yy)
    deviation = 0.5 * (xx - yy)
    radius = np.sqrt(deviation * deviation + xy * xy)
    first = -artificial.fraction * max(mean + radius, 0.0)
    second = -artificial.fraction * max(mean - radius, 0.0)
    spread = 0.5 * (first - second) / max(radius, 1e-300)
    middle = 0.5 * (first + second)
    return middle + spread * deviation, middle - spread * deviation, spread * xy


@compiled_inner
def closeness(artificial, kernel_value):
    """f_ijⁿ with f_ij = W(r_ij)/W(mean spacing), by binary powers: no branch, so loops vectorise."""
    f = kernel_value / artificial.kernel_at_spacing
    power = 1.0
    for bit in range(4):
        chosen = float((artificial.exponent >> bit) & 1)
        power *= 1.0 + chosen * (f - 1.0)
        f *= f
    return power


@compiled_inner
def factor(artificial, shape, q):
    """f_ijⁿ of two particles q smoothing lengths apart; 0 without artificial stress."""
    if artificial is None:
        return 0.0
    return closeness(artificial, kernel.value(shape, q))


@compiled_inner
def load(artificial, row, xx, yy, xy, data):
    """R of every particle, from its stress [N] (Pa), into three rows of the pair data."""
    if artificial is None:
        return
    for i in range(xx.size):
        r_xx, r_yy, r_xy = principal_pressure(artificial, xx[i], yy[i], xy[i])
        data[row, i] = r_xx
        data[row + 1, i] = r_yy
        data[row + 2, i] = r_xy


@compiled_inner
def stresses(artificial, row, data, begin, count):
    """R of a batch of particles, xx, yy, xy; without artificial stress nothing reads what is returned."""
    end = begin + count
    if artificial is None:
        return data[0, begin:end], data[0, begin:end], data[0, begin:end]
    return data[row, begin:end], data[row + 1, begin:end], data[row + 2, begin:end]
