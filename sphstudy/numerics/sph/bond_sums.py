"""Sums over bonds: moments of positions, forces of fluxes.

A run's bonds lie in contiguous memory and vectorise. Sums go block by block, even blocks first
(sph.pair_blocks), on several threads unless `parallel` is None.
"""

import numpy as np
from numba import get_thread_id, prange

from sphstudy.numerics.compilation import compiled, compiled_inner, compiled_parallel
from sphstudy.numerics.sph.hourglass import XX, XY, YX, YY, pull

BATCH = 256
"""Bonds whose terms are kept at a time: the buffers stay in the innermost cache."""


def buffers(threads: int) -> np.ndarray:
    """Terms of one batch for each thread [threads, 2, BATCH]."""
    return np.zeros((threads, 2, BATCH))


@compiled_inner
def _add_moments(x, y, i, j, count, there, along, across, at, into):
    """Adds w x_ij ⊗ X_ij of a run to its particles from `at` on; the same for both ends of a bond."""
    xi, xj, yi, yj = x[i : i + count], x[j : j + count], y[i : i + count], y[j : j + count]
    xx, xy = into[XX, at : at + count], into[XY, at : at + count]
    yx, yy = into[YX, at : at + count], into[YY, at : at + count]
    for k in range(count):
        dx, dy = there[k] * (xj[k] - xi[k]), there[k] * (yj[k] - yi[k])
        xx[k] += dx * along
        xy[k] += dx * across
        yx[k] += dy * along
        yy[k] += dy * across


@compiled_inner
def _moments_of_block(b, x, y, into, block):
    for r in range(b.run_begin[block], b.run_begin[block + 1]):
        w = b.run_weight[r]
        along, across = w * b.run_x[r], w * b.run_y[r]
        for low in range(0, b.length[r], BATCH):
            count = min(BATCH, b.length[r] - low)
            i, at = b.start[r] + low, b.at[r] + low
            j = i + b.offset[r]
            there = b.there[at : at + count]
            _add_moments(x, y, i, j, count, there, along, across, i, into)
            _add_moments(x, y, i, j, count, there, along, across, j, into)
    for p in range(b.single_begin[block], b.single_begin[block + 1]):
        i, j = b.first[p], b.second[p]
        dx, dy = b.weight[p] * (x[j] - x[i]), b.weight[p] * (y[j] - y[i])
        for end in (i, j):
            into[XX, end] += dx * b.x[p]
            into[XY, end] += dx * b.y[p]
            into[YX, end] += dy * b.x[p]
            into[YY, end] += dy * b.y[p]


@compiled_parallel
def _moments_in_parallel(b, x, y, into, parity):
    for half in prange((b.run_begin.size - parity) // 2):
        _moments_of_block(b, x, y, into, 2 * half + parity)


@compiled
def moments(parallel, bonds, x, y, into):
    """Σ_j w_ij x_ij ⊗ X_ij [4, N] of the positions x, y [N] (m) into `into`, xx, xy, yx, yy."""
    into[:] = 0.0
    for parity in range(2):
        if parallel is None:
            for block in range(parity, bonds.run_begin.size - 1, 2):
                _moments_of_block(bonds, x, y, into, block)
        else:
            _moments_in_parallel(bonds, x, y, into, parity)


@compiled_inner
def _force_terms(x, y, flux, i, j, count, there, along, across, weight, hourglass, terms):
    """(A_i + A_j) `along, across` + 2 ζµ w x_ij of `count` bonds (i + k, j + k)."""
    i1, j1 = i + count, j + count
    xi, xj, yi, yj = x[i:i1], x[j:j1], y[i:i1], y[j:j1]
    xx_i, xy_i, yx_i, yy_i = flux[XX, i:i1], flux[XY, i:i1], flux[YX, i:i1], flux[YY, i:i1]
    xx_j, xy_j, yx_j, yy_j = flux[XX, j:j1], flux[XY, j:j1], flux[YX, j:j1], flux[YY, j:j1]
    term_x, term_y = terms[0], terms[1]
    for k in range(count):
        f_x = (
            (xx_i[k] + xx_j[k]) * along
            + (xy_i[k] + xy_j[k]) * across
            + pull(hourglass, weight, xj[k] - xi[k])
        )
        f_y = (
            (yx_i[k] + yx_j[k]) * along
            + (yy_i[k] + yy_j[k]) * across
            + pull(hourglass, weight, yj[k] - yi[k])
        )
        term_x[k] = there[k] * f_x
        term_y[k] = there[k] * f_y


@compiled_inner
def _add_force(terms, sign, begin, count, force):
    force_x, force_y = force[0, begin : begin + count], force[1, begin : begin + count]
    term_x, term_y = terms[0], terms[1]
    for k in range(count):
        force_x[k] += sign * term_x[k]
        force_y[k] += sign * term_y[k]


@compiled_inner
def _forces_of_block(b, x, y, flux, hourglass, terms, force, block):
    for r in range(b.run_begin[block], b.run_begin[block + 1]):
        w = b.run_weight[r]
        along, across = w * b.run_x[r], w * b.run_y[r]
        for low in range(0, b.length[r], BATCH):
            count = min(BATCH, b.length[r] - low)
            i, at = b.start[r] + low, b.at[r] + low
            j = i + b.offset[r]
            there = b.there[at : at + count]
            _force_terms(x, y, flux, i, j, count, there, along, across, w, hourglass, terms)
            _add_force(terms, 1.0, i, count, force)
            _add_force(terms, -1.0, j, count, force)
    for p in range(b.single_begin[block], b.single_begin[block + 1]):
        i, j = b.first[p], b.second[p]
        along, across = b.x[p], b.y[p]
        f_x = (flux[XX, i] + flux[XX, j]) * along + (flux[XY, i] + flux[XY, j]) * across
        f_y = (flux[YX, i] + flux[YX, j]) * along + (flux[YY, i] + flux[YY, j]) * across
        f_x = b.weight[p] * (f_x + pull(hourglass, 1.0, x[j] - x[i]))
        f_y = b.weight[p] * (f_y + pull(hourglass, 1.0, y[j] - y[i]))
        force[0, i] += f_x
        force[1, i] += f_y
        force[0, j] -= f_x
        force[1, j] -= f_y


@compiled_parallel
def _forces_in_parallel(b, x, y, flux, hourglass, terms, force, parity):
    for half in prange((b.run_begin.size - parity) // 2):
        _forces_of_block(b, x, y, flux, hourglass, terms[get_thread_id()], force, 2 * half + parity)


@compiled
def forces(parallel, bonds, x, y, flux, hourglass, terms, force):
    """Σ_j w_ij [(A_i + A_j) X_ij + 2 ζµ x_ij] [2, N] (N/m) of the fluxes A [4, N] into `force`.

    hourglass: ζµ (Pa); None, and the second term is not compiled.
    """
    force[:] = 0.0
    for parity in range(2):
        if parallel is None:
            for block in range(parity, bonds.run_begin.size - 1, 2):
                _forces_of_block(bonds, x, y, flux, hourglass, terms[0], force, block)
        else:
            _forces_in_parallel(bonds, x, y, flux, hourglass, terms, force, parity)
