"""The thesis's updated Lagrangian SPH: time derivatives of position, velocity, density and stress.

State: one array [8, N] with the rows below. Everything on the right-hand side uses the smoothed
velocity ṽ of XSPH. A term that is None in the model is not compiled: the types of the model's fields
specialise every function here.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.numerics.compilation import compiled, compiled_inner
from sphstudy.numerics.sph import (
    artificial_stress,
    damping,
    neighbours,
    pair_sums,
    smearing,
    spin,
    viscosity,
    xsph,
)
from sphstudy.numerics.sph.artificial_stress import ArtificialStress
from sphstudy.numerics.sph.constraints import prescribe, release
from sphstudy.numerics.sph.crack import Crack
from sphstudy.numerics.sph.kernel import Kernel
from sphstudy.numerics.sph.neighbours import Neighbours
from sphstudy.numerics.sph.pair_sums import Workspace
from sphstudy.numerics.sph.viscosity import Viscosity

X, Y, VX, VY, RHO, SXX, SYY, SXY = range(8)
STATE_ROWS = 8

LONGEST_STRIDE = 0.125
"""Of the support: how far a particle may move in one step. About a third of a spacing."""


class Model(NamedTuple):
    """Everything the right-hand side needs besides the state; optional terms are None.

    mass [N] (kg/m); smoothing_length (m); normalisation α of the kernel (1/m²); skin (m) of the
    neighbour list; lame_modulus, shear_modulus, bulk_modulus (Pa); xsph: µ of (2.20); spin: True for
    Jaumann's rate; damping: γ of (2.23) (1/s); smoothing: η of (2.26). `prescribe_smoothed`: constrained
    particles' ṽ is prescribed too; `prescribe_again`: constrained velocities are prescribed again after
    the smearing.
    """

    mass: np.ndarray
    kernel: Kernel
    smoothing_length: float
    normalisation: float
    skin: float
    lame_modulus: float
    shear_modulus: float
    bulk_modulus: float
    constraints: Constraints
    prescribe_smoothed: bool
    prescribe_again: bool
    xsph: float | None
    viscosity: Viscosity | None
    artificial: ArtificialStress | None
    spin: bool | None
    damping: float | None
    smoothing: float | None
    crack: Crack | None


def workspace(model: Model, count: int, threads: int = 1) -> Workspace:
    """Workspace for `count` particles and so many threads; rows exist only for the terms in the model."""
    rows = pair_sums.SOUND + (model.viscosity is not None) + 3 * (model.artificial is not None)
    turning = int(model.spin is not None)
    return Workspace(
        pair_data=np.zeros((rows, count)),
        sums=np.zeros((6 + turning, count)),
        terms=np.zeros((threads, 5 + turning, pair_sums.BATCH)),
        gathered=np.zeros((threads, rows, 2 * pair_sums.BATCH)),
        parallel=True if threads > 1 else None,
    )


def build_neighbours(model: Model, state: np.ndarray, stride: float = 0.0) -> Neighbours | None:
    """Neighbour list of the state [8, N], good for at least one step in which nothing moves farther than
    `stride` (m). None if that is more than an eighth of the support: no solid moves so in a step.
    """
    if not stride <= LONGEST_STRIDE * model.kernel.support * model.smoothing_length:
        return None
    return neighbours_at(model, state[X], state[Y], max(model.skin, 4.0 * stride))


def neighbours_at(model: Model, x: np.ndarray, y: np.ndarray, skin: float) -> Neighbours:
    """Neighbour list of the configuration x, y [N] (m) with this skin (m)."""
    support = model.kernel.support * model.smoothing_length
    return neighbours.build(x, y, support, skin, model.crack)


@compiled
def fastest(model, state, amplitude_rate):
    """Largest speed (m/s) that a particle has, or is about to be given by its constraints.

    No smoothed velocity is larger: (2.20) with µ ≤ 1 is a mean of velocities, near enough.
    """
    largest = 0.0
    for i in range(state.shape[1]):
        squared = state[VX, i] ** 2 + state[VY, i] ** 2
        if not squared <= largest:
            largest = squared
    driven = 0.0
    for target in model.constraints.x_target:
        driven = max(driven, abs(target * amplitude_rate))
    for target in model.constraints.y_target:
        driven = max(driven, abs(target * amplitude_rate))
    return np.sqrt(largest) + 2.0 * driven


@compiled_inner
def _load_motion(model, state, data):
    """Position, velocity, mass and density of every particle into the pair data."""
    for i in range(state.shape[1]):
        data[pair_sums.X, i] = state[X, i]
        data[pair_sums.Y, i] = state[Y, i]
        data[pair_sums.U, i] = state[VX, i]
        data[pair_sums.V, i] = state[VY, i]
        data[pair_sums.MASS, i] = model.mass[i]
        data[pair_sums.RHO, i] = state[RHO, i]


@compiled_inner
def _load_stress(model, state, data):
    """What the momentum pass needs besides the motion: stress, 1/ρ, c, R."""
    for i in range(state.shape[1]):
        data[pair_sums.SPECIFIC, i] = 1.0 / state[RHO, i]
        data[pair_sums.SXX, i] = state[SXX, i]
        data[pair_sums.SYY, i] = state[SYY, i]
        data[pair_sums.SXY, i] = state[SXY, i]
    viscosity.load_sound_speed(model.viscosity, model.bulk_modulus, state[RHO], pair_sums.SOUND, data)
    row = pair_sums.artificial_row(model.viscosity)
    artificial_stress.load(model.artificial, row, state[SXX], state[SYY], state[SXY], data)


@compiled_inner
def _smoothed_velocity(model, state, pairs, amplitude_rate, work):
    """ṽ into the pair data, beside what else moves."""
    _load_motion(model, state, work.pair_data)
    xsph.smooth(model.xsph, model, pairs, amplitude_rate, work)


@compiled
def begin_step(smoothing, model, state, pairs, amplitude_rate, work):
    """Prescribes velocities and smears them (2.26), unless `smoothing`, its η, is None."""
    prescribe(model.constraints, state[VX], state[VY], amplitude_rate)
    if smoothing is None:
        return
    _smoothed_velocity(model, state, pairs, amplitude_rate, work)
    data = work.pair_data
    smearing.smear(smoothing, data[pair_sums.U], data[pair_sums.V], state[VX], state[VY])
    if model.prescribe_again:
        prescribe(model.constraints, state[VX], state[VY], amplitude_rate)


@compiled
def rates(model, state, pairs, amplitude_rate, work, rate):
    """Time derivative of the state [8, N] into `rate`: equations 2.24, 2.17, 2.16 and 2.4.

    Accelerations still contain the constrained degrees of freedom (their reaction, per mass) and no
    damping: `constrain` finishes them.
    """
    data, sums = work.pair_data, work.sums
    _smoothed_velocity(model, state, pairs, amplitude_rate, work)
    _load_stress(model, state, data)
    pair_sums.sum_momentum(work.parallel, model, pairs, work)
    two_mu = 2.0 * model.shear_modulus
    for i in range(state.shape[1]):
        mean_rate = model.lame_modulus * (sums[3, i] + sums[4, i])
        rate[X, i] = data[pair_sums.U, i]
        rate[Y, i] = data[pair_sums.V, i]
        rate[VX, i] = sums[0, i]
        rate[VY, i] = sums[1, i]
        rate[RHO, i] = -sums[2, i]
        rate[SXX, i] = mean_rate + two_mu * sums[3, i]
        rate[SYY, i] = mean_rate + two_mu * sums[4, i]
        rate[SXY, i] = two_mu * sums[5, i]
    spin.corotate(model.spin, sums, state[SXX], state[SYY], state[SXY], rate[SXX], rate[SYY], rate[SXY])


@compiled
def constrain(model, rate, work):
    """Adds the damping -γ ṽ to the accelerations and removes those of constrained freedoms."""
    data = work.pair_data
    damping.add(model.damping, data[pair_sums.U], data[pair_sums.V], rate[VX], rate[VY])
    release(model.constraints, rate[VX], rate[VY])
