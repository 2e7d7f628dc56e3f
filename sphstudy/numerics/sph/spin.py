"""Jaumann's rate: stress turns with the body (Gray, Monaghan & Swift 2001, equation 4).

The spin ω_xy = ½ (∂u/∂y - ∂v/∂x) is summed over pairs beside the strain rate, in the last row of terms
and of sums. The thesis has no such term.
"""

from sphstudy.numerics.compilation import compiled_inner


@compiled_inner
def set_term(spin, terms, k, value):
    """Keeps the antisymmetric part of (v_j - v_i) ∂W of a pair."""
    if spin is None:
        return
    terms[terms.shape[0] - 1, k] = value


@compiled_inner
def add(spin, sums, mass, specific, terms, begin, count):
    """Adds the terms to the particles from `begin` on, weighted by volume; mass, 1/ρ: their partners'."""
    if spin is None:
        return
    total, skew = sums[sums.shape[0] - 1, begin : begin + count], terms[terms.shape[0] - 1]
    for k in range(count):
        total[k] += mass[k] * specific[k] * skew[k]


@compiled_inner
def add_of_singles(spin, pairs, low, count, mass, specific, sums, terms):
    """The same for pairs that lie anywhere in memory."""
    if spin is None:
        return
    total, skew = sums[sums.shape[0] - 1], terms[terms.shape[0] - 1]
    for k in range(count):
        i, j = pairs.first[low + k], pairs.second[low + k]
        total[i] += mass[j] * specific[j] * skew[k]
        total[j] += mass[i] * specific[i] * skew[k]


@compiled_inner
def corotate(spin, sums, stress_xx, stress_yy, stress_xy, rate_xx, rate_yy, rate_xy):
    """Adds ωσ - σω to the rates of stress [N] (Pa/s)."""
    if spin is None:
        return
    omega = sums[sums.shape[0] - 1]
    for i in range(omega.size):
        xx, yy, xy = stress_xx[i], stress_yy[i], stress_xy[i]
        rate_xx[i] += 2.0 * omega[i] * xy
        rate_yy[i] -= 2.0 * omega[i] * xy
        rate_xy[i] += omega[i] * (yy - xx)
