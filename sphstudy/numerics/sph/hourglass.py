"""Hourglass energy ½ ζ µ Σ_i Σ_j w_ij |x_ij - F_i X_ij|²: it costs what F does not see.

ζ = 1 makes the shear part of the force a Laplacian (Zhang, Wu & Hu 2024). `hourglass` is ζ µ (Pa), or
None.
"""

from sphstudy.numerics.compilation import compiled, compiled_inner

XX, XY, YX, YY = range(4)


@compiled_inner
def modulus(hourglass):
    """ζ µ (Pa); 0 if it is None."""
    return 0.0 if hourglass is None else hourglass


@compiled_inner
def pull(hourglass, weight, apart):
    """2 ζµ w x_ij of one component of a bond. `hourglass` goes all the way down as it is: a function that
    returned either None or a number would return an optional one, and Numba's threads lose which it is.
    """
    return 0.0 if hourglass is None else 2.0 * hourglass * weight * apart


@compiled_inner
def _misfit(gradient, i, dx, dy, x, y):
    """|x_ij - F_i X_ij|² [m²]."""
    off_x = dx - gradient[XX, i] * x - gradient[XY, i] * y
    off_y = dy - gradient[YX, i] * x - gradient[YY, i] * y
    return off_x * off_x + off_y * off_y


@compiled
def energy(hourglass, b, gradient, x, y):
    """The energy [J/m] of bonds b at the positions x, y [N] (m) with gradients F [4, N]; 0 if None."""
    if hourglass is None:
        return 0.0
    misfit = 0.0
    for r in range(b.start.size):
        for i in range(b.start[r], b.start[r] + b.length[r]):
            j = i + b.offset[r]
            for end in (i, j):
                w = b.there[b.at[r] + i - b.start[r]] * b.run_weight[r]
                misfit += w * _misfit(gradient, end, x[j] - x[i], y[j] - y[i], b.run_x[r], b.run_y[r])
    for p in range(b.first.size):
        i, j = b.first[p], b.second[p]
        for end in (i, j):
            misfit += b.weight[p] * _misfit(gradient, end, x[j] - x[i], y[j] - y[i], b.x[p], b.y[p])
    return 0.5 * hourglass * misfit
