"""Invariants of a state of the updated Lagrangian method."""

import numpy as np

from sphstudy.numerics.compilation import compiled, compiled_inner
from sphstudy.numerics.sph.invariants import Invariants
from sphstudy.numerics.sph.updated_lagrangian import RHO, SXX, SXY, SYY, VX, VY, X, Y


@compiled_inner
def _distance_squared(state, i, j):
    return (state[X, i] - state[X, j]) ** 2 + (state[Y, i] - state[Y, j]) ** 2


@compiled
def measure(state, rate, mass, youngs_modulus, poisson_ratio, constraints, amplitude_rate, pairs):
    """Invariants of a state [8, N] with unconstrained, undamped rates [8, N].

    The strain energy ½ σ:ε m/ρ takes the strains from the stresses with the E and ν given (those that
    make Hooke's law look like plane stress). net_internal_force: |Σ m a| / Σ m |a|, zero to round-off
    if every force has its reaction. constraint_power: what the constraints put in (W/m), moving with
    target · `amplitude_rate`. Smallest
    spacing: over the pairs of the neighbour list (m).
    """
    speed_squared = p_x = p_y = spin = kinetic = strain = fastest = 0.0
    force_x = force_y = force_sum = power = 0.0
    for i in range(mass.size):
        m, v_x, v_y = mass[i], state[VX, i], state[VY, i]
        squared = v_x * v_x + v_y * v_y
        speed_squared += squared
        fastest = max(fastest, squared)
        p_x += m * v_x
        p_y += m * v_y
        spin += m * (state[X, i] * v_y - state[Y, i] * v_x)
        kinetic += 0.5 * m * squared
        xx, yy, xy = state[SXX, i], state[SYY, i], state[SXY, i]
        normal = xx * xx + yy * yy - 2.0 * poisson_ratio * xx * yy
        shear = 2.0 * (1.0 + poisson_ratio) * xy * xy
        strain += 0.5 * (normal + shear) / youngs_modulus * m / state[RHO, i]
        force_x += m * rate[VX, i]
        force_y += m * rate[VY, i]
        force_sum += m * np.hypot(rate[VX, i], rate[VY, i])
    for k in range(constraints.x_index.size):
        i = constraints.x_index[k]
        power -= mass[i] * rate[VX, i] * constraints.x_target[k] * amplitude_rate
    for k in range(constraints.y_index.size):
        i = constraints.y_index[k]
        power -= mass[i] * rate[VY, i] * constraints.y_target[k] * amplitude_rate
    closest = np.inf
    for r in range(pairs.start.size):
        for i in range(pairs.start[r], pairs.start[r] + pairs.length[r]):
            closest = min(closest, _distance_squared(state, i, i + pairs.offset[r]))
    for p in range(pairs.singles[0]):
        closest = min(closest, _distance_squared(state, pairs.first[p], pairs.second[p]))
    return Invariants(
        np.sqrt(speed_squared),
        p_x,
        p_y,
        spin,
        kinetic,
        strain,
        np.sqrt(fastest),
        np.sqrt(closest),
        np.hypot(force_x, force_y) / force_sum if force_sum > 0.0 else 0.0,
        power,
    )
