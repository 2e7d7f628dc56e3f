"""The thesis's right-hand side once more, as plain NumPy over all pairs: a twin to check against.

Written from the equations, with none of the product's code: arrays [N, N], no neighbour search, no
symmetry used, kernel in its printed pieces, artificial stress by rotation with an angle.
"""

from itertools import pairwise

import numpy as np


def kernel(shape, r, h):
    """W at distances r (m): (2.7), Wendland C2, or the quintic spline, in the books' pieces."""
    q = r / h
    if shape.wendland is not None:
        return (
            7.0 / (4.0 * np.pi * h**2) * np.where(q <= 2.0, (1.0 - q / 2.0) ** 4 * (2.0 * q + 1.0), 0.0)
        )
    if shape.quintic is not None:
        three, two, one = (3.0 - q) ** 5, (2.0 - q) ** 5, (1.0 - q) ** 5
        pieces = [three - 6.0 * two + 15.0 * one, three - 6.0 * two, three]
        return 7.0 / (478.0 * np.pi * h**2) * np.select([q < 1.0, q < 2.0, q < 3.0], pieces)
    inner = 2.0 / 3.0 - q**2 + q**3 / 2.0
    outer = (2.0 - q) ** 3 / 6.0
    return 15.0 / (7.0 * np.pi * h**2) * np.where(q <= 1.0, inner, np.where(q <= 2.0, outer, 0.0))


def kernel_slope(shape, r, h):
    """dW/dr at distances r (m)."""
    q = r / h
    if shape.wendland is not None:
        return 7.0 / (4.0 * np.pi * h**3) * np.where(q <= 2.0, -5.0 * q * (1.0 - q / 2.0) ** 3, 0.0)
    if shape.quintic is not None:
        three, two, one = (3.0 - q) ** 4, (2.0 - q) ** 4, (1.0 - q) ** 4
        pieces = [three - 6.0 * two + 15.0 * one, three - 6.0 * two, three]
        return -35.0 / (478.0 * np.pi * h**3) * np.select([q < 1.0, q < 2.0, q < 3.0], pieces)
    inner = -2.0 * q + 1.5 * q**2
    outer = -((2.0 - q) ** 2) / 2.0
    return 15.0 / (7.0 * np.pi * h**3) * np.where(q <= 1.0, inner, np.where(q <= 2.0, outer, 0.0))


def sees(x, y, crack):
    """[N, N]: whether i and j see each other past the polyline of floating nodes."""
    count = x.size
    seen = np.ones((count, count), bool)
    if crack is None:
        return seen
    first, second, tolerance = crack.first, crack.second, crack.tolerance
    nodes = 0.5 * np.array([x[first] + x[second], y[first] + y[second]]).T
    low, high = -tolerance, 1.0 + tolerance
    for i in range(count):
        for j in range(count):
            for p, q in pairwise(nodes):
                a = np.array([x[i], y[i]])
                b = np.array([x[j], y[j]])
                matrix = np.array([b - a, p - q]).T
                if abs(np.linalg.det(matrix)) < 1e-300:
                    continue
                one, two = np.linalg.solve(matrix, p - a)
                if low <= one <= high and low <= two <= high:
                    seen[i, j] = False
    return seen


def artificial_stress(xx, yy, xy, zeta):
    """R (2.25) by rotation to principal axes and back."""
    theta = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    s, c = np.sin(theta), np.cos(theta)
    one = c * c * xx + 2.0 * s * c * xy + s * s * yy
    two = s * s * xx - 2.0 * s * c * xy + c * c * yy
    r_one = np.where(one > 0.0, -zeta * one, 0.0)
    r_two = np.where(two > 0.0, -zeta * two, 0.0)
    return c * c * r_one + s * s * r_two, s * s * r_one + c * c * r_two, s * c * (r_one - r_two)


def rates(model, state):
    """Derivative [8, N] of the state, and the smoothed velocity [2, N]; no constraints, no damping."""
    x, y, vx, vy, rho, sxx, syy, sxy = state
    m, h, shape = model.mass, model.smoothing_length, model.kernel
    dx, dy = x[:, None] - x[None, :], y[:, None] - y[None, :]
    r = np.hypot(dx, dy)
    near = (r < shape.support * h) & sees(x, y, model.crack)
    np.fill_diagonal(near, False)
    w = np.where(near, kernel(shape, r, h), 0.0)
    safe = np.where(r > 0.0, r, 1.0)
    gx = np.where(near, kernel_slope(shape, r, h) * dx / safe, 0.0)
    gy = np.where(near, kernel_slope(shape, r, h) * dy / safe, 0.0)

    if model.xsph is not None:
        weight = m[None, :] * w / (0.5 * (rho[:, None] + rho[None, :]))
        ux = vx + model.xsph * np.sum((vx[None, :] - vx[:, None]) * weight, axis=1)
        uy = vy + model.xsph * np.sum((vy[None, :] - vy[:, None]) * weight, axis=1)
    else:
        ux, uy = vx.copy(), vy.copy()
    du, dv = ux[None, :] - ux[:, None], uy[None, :] - uy[:, None]

    stress = [s[:, None] + s[None, :] for s in (sxx, syy, sxy)]
    if model.artificial is not None:
        pieces = artificial_stress(sxx, syy, sxy, model.artificial.fraction)
        spacing_kernel = model.artificial.kernel_at_spacing * shape.normalisation(h)
        f = (kernel(shape, r, h) / spacing_kernel) ** model.artificial.exponent
        stress = [s + (p[:, None] + p[None, :]) * f for s, p in zip(stress, pieces, strict=True)]
    stress = [s / (rho[:, None] * rho[None, :]) for s in stress]
    if model.viscosity is not None:
        c = np.sqrt(model.bulk_modulus / rho)
        approach = -(dx * du + dy * dv)
        phi = h * np.minimum(0.0, approach) / (r**2 + (h / 10.0) ** 2)
        alpha, beta = model.viscosity.linear, model.viscosity.quadratic
        pi = -alpha * (c[:, None] + c[None, :]) * phi + 2.0 * beta * phi**2
        pi = pi / (rho[:, None] + rho[None, :])
        stress[0], stress[1] = stress[0] - pi, stress[1] - pi

    out = np.zeros_like(state)
    out[0], out[1] = ux, uy
    out[2] = np.sum(m[None, :] * (stress[0] * gx + stress[2] * gy), axis=1)
    out[3] = np.sum(m[None, :] * (stress[2] * gx + stress[1] * gy), axis=1)
    out[4] = np.sum(m[None, :] * (-du * gx - dv * gy), axis=1)
    volume = (m / rho)[None, :]
    exx, eyy = np.sum(du * gx * volume, axis=1), np.sum(dv * gy * volume, axis=1)
    exy = 0.5 * np.sum((du * gy + dv * gx) * volume, axis=1)
    out[5] = model.lame_modulus * (exx + eyy) + 2.0 * model.shear_modulus * exx
    out[6] = model.lame_modulus * (exx + eyy) + 2.0 * model.shear_modulus * eyy
    out[7] = 2.0 * model.shear_modulus * exy
    if model.spin is not None:
        half = 0.5 * np.sum((du * gy - dv * gx) * volume, axis=1)
        turn = np.array([[np.zeros_like(half), half], [-half, np.zeros_like(half)]])
        sigma = np.array([[sxx, sxy], [sxy, syy]])
        more = np.einsum("abn,bcn->acn", turn, sigma) - np.einsum("abn,bcn->acn", sigma, turn)
        out[5], out[6], out[7] = out[5] + more[0, 0], out[6] + more[1, 1], out[7] + more[0, 1]
    return out, np.array([ux, uy])
