"""Explicit stepping of a potential: velocity Verlet (kick, drift, kick), or Heun's method.

State: one array [6, N] with the rows below. The accelerations that end a step begin the next, so that the
forces are evaluated once a step (Verlet) and chunking changes no bit of the result.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled, compiled_inner
from sphstudy.numerics.sph import damping, neighbours, total_lagrangian, viscosity
from sphstudy.numerics.sph.constraints import prescribe

X, Y, VX, VY, AX, AY = range(6)
STATE_ROWS = 6

CHECK_INTERVAL = 50
"""Steps between two looks at whether the run is still sound."""

SOUND, NOT_FINITE, INVERTED, TOO_FAR, TOO_FAST, OUTDATED = range(6)
"""What `advance` says about the state; OUTDATED: pairs in contact need renewal before the next step."""

LARGEST = 1e100
"""Of any number in a state, in its SI unit: their squares are finite too."""

LONGEST_STRIDE = 0.25
"""Smoothing lengths that a particle may move in a step: no solid moves faster, an unstable step does."""


class Buffers(NamedTuple):
    """What one step needs besides the state: F and A, forces [2, N], and Heun's predicted state."""

    work: total_lagrangian.Workspace
    force: np.ndarray
    predicted: np.ndarray


def buffers(count: int, threads: int = 1) -> Buffers:
    """Buffers for `count` particles, summed by `threads` threads."""
    work = total_lagrangian.workspace(count, threads)
    return Buffers(work, np.zeros((2, count)), np.zeros((STATE_ROWS, count)))


@compiled
def accelerate(model, state, memory):
    """Accelerations (m/s²) of a state into its rows, without damping; constrained ones are their
    reactions over the mass, with the opposite sign.
    """
    force = memory.force
    total_lagrangian.force(model, state[X], state[Y], memory.work, force)
    viscosity.add_forces(model.viscosity, model, state[VX], state[VY], state[X], state[Y], force)
    for i in range(state.shape[1]):
        state[AX, i] = force[0, i] / model.mass[i]
        state[AY, i] = force[1, i] / model.mass[i]


@compiled
def soundness(model, state, memory, dt):
    """Whether all is finite, nothing turned inside out, nothing outruns sound or moves too far in a step.

    Written as comparisons with the largest value: rearranged arithmetic takes x - x for zero, and with it
    every number for finite.
    """
    for i in range(state.shape[1]):
        for row in range(STATE_ROWS):
            if not abs(state[row, i]) <= LARGEST:
                return NOT_FINITE
    if total_lagrangian.inverted(model.law, memory.work.gradient) > 0:
        return INVERTED
    for i in range(state.shape[1]):
        speed = np.sqrt(state[VX, i] ** 2 + state[VY, i] ** 2)
        if speed * dt > LONGEST_STRIDE * model.smoothing_length:
            return TOO_FAR
        if speed > model.wave_speed:
            return TOO_FAST
    return SOUND


@compiled_inner
def _outdated(contact, state, dt):
    """Whether a pair in contact may be missed in the next step."""
    if contact is None:
        return False
    fastest = 0.0
    for i in range(state.shape[1]):
        speed = np.hypot(state[VX, i], state[VY, i]) + dt * np.hypot(state[AX, i], state[AY, i])
        fastest = max(fastest, speed)
    return neighbours.outdated(contact, state[X], state[Y], dt * fastest)


@compiled_inner
def _verlet_step(model, state, memory, amplitude_rate, dt):
    damped = 0.5 * dt * damping.rate(model.damping)
    for i in range(state.shape[1]):
        state[VX, i] = (1.0 - damped) * state[VX, i] + 0.5 * dt * state[AX, i]
        state[VY, i] = (1.0 - damped) * state[VY, i] + 0.5 * dt * state[AY, i]
    prescribe(model.constraints, state[VX], state[VY], amplitude_rate)
    for i in range(state.shape[1]):
        state[X, i] += dt * state[VX, i]
        state[Y, i] += dt * state[VY, i]
    accelerate(model, state, memory)
    for i in range(state.shape[1]):
        state[VX, i] = (state[VX, i] + 0.5 * dt * state[AX, i]) / (1.0 + damped)
        state[VY, i] = (state[VY, i] + 0.5 * dt * state[AY, i]) / (1.0 + damped)
    prescribe(model.constraints, state[VX], state[VY], amplitude_rate)


@compiled_inner
def _heun_step(model, state, memory, amplitude_rate, dt):
    predicted, gamma = memory.predicted, damping.rate(model.damping)
    prescribe(model.constraints, state[VX], state[VY], amplitude_rate)
    for i in range(state.shape[1]):
        predicted[X, i] = state[X, i] + dt * state[VX, i]
        predicted[Y, i] = state[Y, i] + dt * state[VY, i]
        predicted[VX, i] = state[VX, i] + dt * (state[AX, i] - gamma * state[VX, i])
        predicted[VY, i] = state[VY, i] + dt * (state[AY, i] - gamma * state[VY, i])
    prescribe(model.constraints, predicted[VX], predicted[VY], amplitude_rate)
    accelerate(model, predicted, memory)
    half = 0.5 * dt
    for i in range(state.shape[1]):
        vx, vy = state[VX, i], state[VY, i]
        state[X, i] += half * (vx + predicted[VX, i])
        state[Y, i] += half * (vy + predicted[VY, i])
        state[VX, i] += half * (state[AX, i] + predicted[AX, i] - gamma * (vx + predicted[VX, i]))
        state[VY, i] += half * (state[AY, i] + predicted[AY, i] - gamma * (vy + predicted[VY, i]))
    prescribe(model.constraints, state[VX], state[VY], amplitude_rate)
    accelerate(model, state, memory)


@compiled
def advance(heun, model, state, memory, amplitude_rate, dt, begin, end):
    """Steps from number `begin` to `end`, with Heun's method unless `heun` is None.

    `state` [6, N] is updated in place; `accelerate` must have brought it and the buffers up to date.
    Prescribed freedoms move with target · `amplitude_rate`. Returns (steps taken in all, soundness or
    OUTDATED).
    """
    for step in range(begin, end):
        if step % CHECK_INTERVAL == 0:
            found = soundness(model, state, memory, dt)
            if found != SOUND:
                return step, found
        if _outdated(model.contact, state, dt):
            return step, OUTDATED
        if heun is None:
            _verlet_step(model, state, memory, amplitude_rate, dt)
        else:
            _heun_step(model, state, memory, amplitude_rate, dt)
    return end, soundness(model, state, memory, dt)
