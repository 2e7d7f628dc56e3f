"""Monaghan's artificial viscosity (2.21)."""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled, compiled_inner


class Viscosity(NamedTuple):
    """α and β of (2.21)."""

    linear: float
    quadratic: float


@compiled_inner
def pressure(viscosity, smoothing_length, approach, distance_squared, c_sum, density_sum):
    """Π_ij ≥ 0 [m⁵/(kg s²)] from x_ij·v_ij, x_ij², c_i + c_j and ρ_i + ρ_j; zero on separation.

    It enters the momentum equation as -Π ∂W. The thesis prints +Π, which with its own Π ≥ 0 would
    feed energy in.
    """
    if viscosity is None:
        return 0.0
    softened = distance_squared + 0.01 * smoothing_length * smoothing_length
    phi = smoothing_length * min(approach, 0.0) / softened
    linear, quadratic = viscosity.linear, viscosity.quadratic
    return phi * (2.0 * quadratic * phi - linear * c_sum) / density_sum


@compiled_inner
def load_sound_speed(viscosity, bulk_modulus, density, row, data):
    """c_i = √(K/ρ_i) (2.22) into a row of the pair data."""
    if viscosity is None:
        return
    for i in range(density.size):
        data[row, i] = np.sqrt(bulk_modulus / density[i])


@compiled_inner
def sound_speeds(viscosity, row, data, begin, count):
    """c of a batch of particles; without viscosity nothing reads what is returned."""
    if viscosity is None:
        return data[0, begin : begin + count]
    return data[row, begin : begin + count]


@compiled_inner
def _push(viscosity, model, velocity_x, velocity_y, x, y, i, j, w, force):
    """Π_ij along the line between the particles as they stand: keeps both momenta."""
    dx, dy = x[j] - x[i], y[j] - y[i]
    approach = dx * (velocity_x[j] - velocity_x[i]) + dy * (velocity_y[j] - velocity_y[i])
    rho_i, rho_j = model.mass[i] / model.volume[i], model.mass[j] / model.volume[j]
    found = pressure(
        viscosity,
        model.smoothing_length,
        approach,
        dx * dx + dy * dy,
        2.0 * model.wave_speed,
        rho_i + rho_j,
    )
    push = w * rho_i * rho_j * found
    force[0, i] -= push * dx
    force[1, i] -= push * dy
    force[0, j] += push * dx
    force[1, j] += push * dy


@compiled
def add_forces(viscosity, model, velocity_x, velocity_y, x, y, force):
    """Adds viscous forces [2, N] (N/m) along the bonds of a potential, unless `viscosity` is None."""
    if viscosity is None:
        return
    b = model.bonds
    for r in range(b.start.size):
        for i in range(b.start[r], b.start[r] + b.length[r]):
            w = b.there[b.at[r] + i - b.start[r]] * b.run_weight[r]
            _push(viscosity, model, velocity_x, velocity_y, x, y, i, i + b.offset[r], w, force)
    for p in range(b.first.size):
        i, j, w = b.first[p], b.second[p], b.weight[p]
        _push(viscosity, model, velocity_x, velocity_y, x, y, i, j, w, force)
