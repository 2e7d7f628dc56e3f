"""The smoothed velocity of XSPH (2.20), summed over pairs as `pair_sums` sums forces."""

import numpy as np
from numba import get_thread_id, prange

from sphstudy.numerics.compilation import compiled_inner, compiled_parallel
from sphstudy.numerics.sph import kernel
from sphstudy.numerics.sph.constraints import prescribe
from sphstudy.numerics.sph.pair_sums import BATCH, MASS, RHO, PairTerms, U, V, X, Y, gather


@compiled_inner
def _smoothing_terms(model, data, i0, j0, count, terms):
    """XSPH (2.20): (v_j - v_i) W_ij / ((ρ_i + ρ_j)/2) for `count` pairs (i0 + k, j0 + k)."""
    i1, j1 = i0 + count, j0 + count
    xi, xj = data[X, i0:i1], data[X, j0:j1]
    yi, yj = data[Y, i0:i1], data[Y, j0:j1]
    ui, uj = data[U, i0:i1], data[U, j0:j1]
    vi, vj = data[V, i0:i1], data[V, j0:j1]
    rho_i, rho_j = data[RHO, i0:i1], data[RHO, j0:j1]
    term_x, term_y = terms[0], terms[1]
    per_length = 1.0 / model.smoothing_length
    scale = 2.0 * model.normalisation
    for k in range(count):
        dx = xi[k] - xj[k]
        dy = yi[k] - yj[k]
        q = np.sqrt(dx * dx + dy * dy) * per_length
        weight = scale * kernel.value(model.kernel, q) / (rho_i[k] + rho_j[k])
        term_x[k] = (uj[k] - ui[k]) * weight
        term_y[k] = (vj[k] - vi[k]) * weight


@compiled_inner
def _add_smoothing(sums, mass, terms, sign, begin, count):
    """Adds sign · m t to the particles from `begin` on; `mass` is their partners'."""
    end = begin + count
    sum_x, sum_y = sums[0, begin:end], sums[1, begin:end]
    term_x, term_y = terms[0], terms[1]
    for k in range(count):
        m = sign * mass[k]
        sum_x[k] += m * term_x[k]
        sum_y[k] += m * term_y[k]


@compiled_inner
def _smooth_singles(model, pairs, work, thread, begin, end):
    data, sums, terms, gathered = work.pair_data, work.sums, work.terms[thread], work.gathered[thread]
    mass = data[MASS]
    left, right = np.int64(0), np.int64(BATCH)  # as literals they would compile the terms twice
    for low in range(begin, end, BATCH):
        count = min(BATCH, end - low)
        gather(data, RHO + 1, pairs, low, count, gathered)
        _smoothing_terms(model, gathered, left, right, count, terms)
        for k in range(count):
            i, j = pairs.first[low + k], pairs.second[low + k]
            for row in range(2):
                sums[row, i] += mass[j] * terms[row, k]
                sums[row, j] -= mass[i] * terms[row, k]


@compiled_inner
def _smooth_block(model, pairs, work, thread, block):
    data, sums, terms = work.pair_data, work.sums, work.terms[thread]
    mass = data[MASS]
    for r in range(pairs.run_begin[block], pairs.run_begin[block + 1]):
        for low in range(0, pairs.length[r], BATCH):
            count = min(BATCH, pairs.length[r] - low)
            i0 = pairs.start[r] + low
            j0 = i0 + pairs.offset[r]
            _smoothing_terms(model, data, i0, j0, count, terms)
            _add_smoothing(sums, mass[j0 : j0 + count], terms, 1.0, i0, count)
            _add_smoothing(sums, mass[i0 : i0 + count], terms, -1.0, j0, count)
    begin, end = pairs.single_begin[block], pairs.single_begin[block + 1]
    _smooth_singles(model, pairs, work, thread, begin, end)


@compiled_parallel
def _smooth_in_parallel(shape, length, normalisation, pairs, work, parity):
    for half in prange((pairs.run_begin.size - parity) // 2):
        terms = PairTerms(shape, length, normalisation, None, None, None)
        _smooth_block(terms, pairs, work, get_thread_id(), 2 * half + parity)


@compiled_inner
def _sum_smoothing(parallel, model, pairs, work):
    """Row 0, 1 of the sums: Σ_j m_j (v_j - v_i) W_ij / ((ρ_i + ρ_j)/2)."""
    work.sums[:2] = 0.0
    for parity in range(2):
        if parallel is None:
            for block in range(parity, pairs.run_begin.size - 1, 2):
                _smooth_block(model, pairs, work, 0, block)
        else:
            _smooth_in_parallel(
                model.kernel, model.smoothing_length, model.normalisation, pairs, work, parity
            )
    _smooth_singles(model, pairs, work, 0, pairs.single_begin[-1], pairs.singles[0])


@compiled_inner
def smooth(xsph, model, pairs, amplitude_rate, work):
    """Turns the velocities of the pair data into ṽ of (2.20), unless `xsph`, its µ, is None; constrained
    particles keep the prescribed velocity.
    """
    if xsph is None:
        return
    data, sums = work.pair_data, work.sums
    _sum_smoothing(work.parallel, model, pairs, work)
    for i in range(data.shape[1]):
        data[U, i] += xsph * sums[0, i]
        data[V, i] += xsph * sums[1, i]
    if model.prescribe_smoothed:
        prescribe(model.constraints, data[U], data[V], amplitude_rate)
