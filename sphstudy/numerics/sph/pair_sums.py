"""Sums over pairs: the forces and strain rates of (2.24) to (2.16), and what all such sums share.

They go block by block, even blocks first (sph.pair_blocks), on several threads unless `parallel` is None.

Each sum works in batches: the pair terms go to a small buffer that stays in the innermost cache
(`_..._terms`, the physics), then they are added to both particles. A run's batch lies in contiguous
memory and vectorises; singles are gathered into the same shape first. A term whose parameter is None
is not compiled, and pair data that only it needs is not allocated.
"""

from typing import NamedTuple

import numpy as np
from numba import get_thread_id, prange

from sphstudy.numerics.compilation import compiled_inner, compiled_parallel
from sphstudy.numerics.sph import artificial_stress, kernel, spin, viscosity
from sphstudy.numerics.sph.artificial_stress import ArtificialStress
from sphstudy.numerics.sph.kernel import Kernel
from sphstudy.numerics.sph.viscosity import Viscosity

# Rows of the pair data, what the loops over pairs read of each particle; U, V: ṽ, SPECIFIC: 1/ρ.
# Then, if the model has viscosity, the sound speed; then, if it has artificial stress, R.
X, Y, U, V, MASS, RHO, SPECIFIC, SXX, SYY, SXY = range(10)
SOUND = 10

BATCH = 256


class Workspace(NamedTuple):
    """Arrays that evaluations reuse: pair data, sums over pairs; for each thread a batch of terms and of
    gathered pair data. parallel: None on one thread, and then nothing is compiled for more.
    """

    pair_data: np.ndarray
    sums: np.ndarray
    terms: np.ndarray
    gathered: np.ndarray
    parallel: bool | None


class PairTerms(NamedTuple):
    """The part of a model that pair terms read. Numba hands no tuple within a tuple to its threads, so
    each of them puts these together again.
    """

    kernel: Kernel
    smoothing_length: float
    normalisation: float
    viscosity: Viscosity | None
    artificial: ArtificialStress | None
    spin: bool | None


@compiled_inner
def artificial_row(viscosity_term):
    """First of the three rows of R in the pair data."""
    return SOUND if viscosity_term is None else SOUND + 1


@compiled_inner
def _momentum_terms(model, data, i0, j0, count, terms):
    """Pair terms of (2.24), (2.16) and (2.17) for `count` pairs (i0 + k, j0 + k).

    terms 0, 1: acceleration per mass of the partner; 2, 3, 4: (v_j - v_i) ∂W, symmetrised, xx, yy, xy; 5:
    its antisymmetric part, unless the model has no spin.
    """
    i1, j1 = i0 + count, j0 + count
    xi, xj = data[X, i0:i1], data[X, j0:j1]
    yi, yj = data[Y, i0:i1], data[Y, j0:j1]
    ui, uj = data[U, i0:i1], data[U, j0:j1]
    vi, vj = data[V, i0:i1], data[V, j0:j1]
    rho_i, rho_j = data[RHO, i0:i1], data[RHO, j0:j1]
    specific_i, specific_j = data[SPECIFIC, i0:i1], data[SPECIFIC, j0:j1]
    xx_i, xx_j = data[SXX, i0:i1], data[SXX, j0:j1]
    yy_i, yy_j = data[SYY, i0:i1], data[SYY, j0:j1]
    xy_i, xy_j = data[SXY, i0:i1], data[SXY, j0:j1]
    c_i = viscosity.sound_speeds(model.viscosity, SOUND, data, i0, count)
    c_j = viscosity.sound_speeds(model.viscosity, SOUND, data, j0, count)
    row = artificial_row(model.viscosity)
    rxx_i, ryy_i, rxy_i = artificial_stress.stresses(model.artificial, row, data, i0, count)
    rxx_j, ryy_j, rxy_j = artificial_stress.stresses(model.artificial, row, data, j0, count)
    force_x, force_y, grad_xx, grad_yy, grad_xy = terms[0], terms[1], terms[2], terms[3], terms[4]
    length = model.smoothing_length
    per_length = 1.0 / length
    scale = model.normalisation * per_length
    tiny = 1e-24 * length * length
    for k in range(count):
        dx = xi[k] - xj[k]
        dy = yi[k] - yj[k]
        du = uj[k] - ui[k]
        dv = vj[k] - vi[k]
        distance_squared = max(dx * dx + dy * dy, tiny)
        distance = np.sqrt(distance_squared)
        q = distance * per_length
        factor = scale * kernel.slope(model.kernel, q) / distance
        gx = factor * dx
        gy = factor * dy
        pi = viscosity.pressure(
            model.viscosity,
            length,
            -(dx * du + dy * dv),
            distance_squared,
            c_i[k] + c_j[k],
            rho_i[k] + rho_j[k],
        )
        f = artificial_stress.factor(model.artificial, model.kernel, q)
        specific = specific_i[k] * specific_j[k]
        xx = (xx_i[k] + xx_j[k] + f * (rxx_i[k] + rxx_j[k])) * specific - pi
        yy = (yy_i[k] + yy_j[k] + f * (ryy_i[k] + ryy_j[k])) * specific - pi
        xy = (xy_i[k] + xy_j[k] + f * (rxy_i[k] + rxy_j[k])) * specific
        force_x[k] = xx * gx + xy * gy
        force_y[k] = xy * gx + yy * gy
        grad_xx[k] = du * gx
        grad_yy[k] = dv * gy
        grad_xy[k] = 0.5 * (du * gy + dv * gx)
        spin.set_term(model.spin, terms, k, 0.5 * (du * gy - dv * gx))


@compiled_inner
def _add_momentum(sums, mass, specific, terms, sign, begin, count):
    """Adds the terms to the particles from `begin` on; mass and 1/ρ are their partners'.

    Rows 0, 1 change sign with the side (Newton's third law); tr(∇v) in row 2 is weighted by mass, the
    strain rate in rows 3 to 5 by volume.
    """
    end = begin + count
    force_x, force_y, trace = sums[0, begin:end], sums[1, begin:end], sums[2, begin:end]
    strain_xx, strain_yy, strain_xy = sums[3, begin:end], sums[4, begin:end], sums[5, begin:end]
    term_x, term_y, grad_xx, grad_yy, grad_xy = terms[0], terms[1], terms[2], terms[3], terms[4]
    for k in range(count):
        m = mass[k]
        volume = m * specific[k]
        force_x[k] += sign * m * term_x[k]
        force_y[k] += sign * m * term_y[k]
        trace[k] += m * (grad_xx[k] + grad_yy[k])
        strain_xx[k] += volume * grad_xx[k]
        strain_yy[k] += volume * grad_yy[k]
        strain_xy[k] += volume * grad_xy[k]


@compiled_inner
def gather(data, rows, pairs, low, count, gathered):
    """Copies the pair data of `count` singles side by side: i at 0, j at BATCH."""
    for row in range(rows):
        source, target = data[row], gathered[row]
        for k in range(count):
            target[k] = source[pairs.first[low + k]]
            target[BATCH + k] = source[pairs.second[low + k]]


@compiled_inner
def _momentum_of_singles(model, pairs, work, thread, begin, end):
    data, sums, terms, gathered = work.pair_data, work.sums, work.terms[thread], work.gathered[thread]
    mass, specific = data[MASS], data[SPECIFIC]
    left, right = np.int64(0), np.int64(BATCH)  # as literals they would compile the terms twice
    for low in range(begin, end, BATCH):
        count = min(BATCH, end - low)
        gather(data, data.shape[0], pairs, low, count, gathered)
        _momentum_terms(model, gathered, left, right, count, terms)
        for k in range(count):
            i, j = pairs.first[low + k], pairs.second[low + k]
            for row in range(2):
                sums[row, i] += mass[j] * terms[row, k]
                sums[row, j] -= mass[i] * terms[row, k]
            trace = terms[2, k] + terms[3, k]
            sums[2, i] += mass[j] * trace
            sums[2, j] += mass[i] * trace
            for row in range(3):
                sums[3 + row, i] += mass[j] * specific[j] * terms[2 + row, k]
                sums[3 + row, j] += mass[i] * specific[i] * terms[2 + row, k]
        spin.add_of_singles(model.spin, pairs, low, count, mass, specific, sums, terms)


@compiled_inner
def _momentum_of_block(model, pairs, work, thread, block):
    data, sums, terms = work.pair_data, work.sums, work.terms[thread]
    mass, specific = data[MASS], data[SPECIFIC]
    for r in range(pairs.run_begin[block], pairs.run_begin[block + 1]):
        for low in range(0, pairs.length[r], BATCH):
            count = min(BATCH, pairs.length[r] - low)
            i0 = pairs.start[r] + low
            j0 = i0 + pairs.offset[r]
            i1, j1 = i0 + count, j0 + count
            _momentum_terms(model, data, i0, j0, count, terms)
            _add_momentum(sums, mass[j0:j1], specific[j0:j1], terms, 1.0, i0, count)
            _add_momentum(sums, mass[i0:i1], specific[i0:i1], terms, -1.0, j0, count)
            spin.add(model.spin, sums, mass[j0:j1], specific[j0:j1], terms, i0, count)
            spin.add(model.spin, sums, mass[i0:i1], specific[i0:i1], terms, j0, count)
    begin, end = pairs.single_begin[block], pairs.single_begin[block + 1]
    _momentum_of_singles(model, pairs, work, thread, begin, end)


@compiled_parallel
def _momentum_in_parallel(
    shape, length, normalisation, viscous, artificial, turning, pairs, work, parity
):
    for half in prange((pairs.run_begin.size - parity) // 2):
        terms = PairTerms(shape, length, normalisation, viscous, artificial, turning)
        _momentum_of_block(terms, pairs, work, get_thread_id(), 2 * half + parity)


@compiled_inner
def sum_momentum(parallel, model, pairs, work):
    """All sums of the momentum pass: six, and the spin if the model has it."""
    work.sums[:] = 0.0
    for parity in range(2):
        if parallel is None:
            for block in range(parity, pairs.run_begin.size - 1, 2):
                _momentum_of_block(model, pairs, work, 0, block)
        else:
            _momentum_in_parallel(
                model.kernel,
                model.smoothing_length,
                model.normalisation,
                model.viscosity,
                model.artificial,
                model.spin,
                pairs,
                work,
                parity,
            )
    _momentum_of_singles(model, pairs, work, 0, pairs.single_begin[-1], pairs.singles[0])
