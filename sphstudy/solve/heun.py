"""Explicit stepping with Heun's method: predictor and trapezoidal corrector (thesis 2.6).

No Python runs inside the time loop. The loop is called in chunks; everything that one step hands to
the next, the neighbour list included, lives in the arrays passed, so that chunking changes no bit of
the result.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.compilation import compiled, compiled_exactly
from sphstudy.sph.updated_lagrangian import (
    RHO,
    STATE_ROWS,
    VX,
    VY,
    Model,
    Workspace,
    X,
    Y,
    begin_step,
    constrain,
    rates,
    refresh_neighbours,
    workspace,
)

CHECK_INTERVAL = 50
"""Steps between two looks at whether the run is still sound."""


class Buffers(NamedTuple):
    """What one step needs besides the state: predicted state, the two derivatives, workspace."""

    predicted: np.ndarray
    first: np.ndarray
    second: np.ndarray
    work: Workspace


def buffers(model: Model, count: int) -> Buffers:
    """Buffers for `count` particles."""
    predicted, first, second = (np.zeros((STATE_ROWS, count)) for _ in range(3))
    return Buffers(predicted, first, second, workspace(model, count))


@compiled_exactly
def is_sound(state, speed_limit):
    """Whether everything is finite, densities are positive and no speed exceeds the limit (m/s)."""
    for i in range(state.shape[1]):
        total = 0.0
        for row in range(STATE_ROWS):
            total += state[row, i]
        speed_squared = state[VX, i] ** 2 + state[VY, i] ** 2
        if not (np.isfinite(total) and state[RHO, i] > 0.0 and speed_squared <= speed_limit**2):
            return False
    return True


@compiled
def advance(model, state, pairs, memory, amplitude_rate, dt, begin, end, speed_limit):
    """Steps from number `begin` to `end`; returns (steps taken in all, still sound, neighbours).

    `state` [8, N] is updated in place. Prescribed freedoms move with target · `amplitude_rate`.
    Every CHECK_INTERVAL steps the state is looked at, and stepping ends there if it is not sound.
    """
    work = memory.work
    for step in range(begin, end):
        if step % CHECK_INTERVAL == 0 and not is_sound(state, speed_limit):
            return step, False, pairs
        pairs = refresh_neighbours(model, pairs, state[X], state[Y])
        begin_step(model, state, pairs, amplitude_rate, work)
        for stage in range(2):
            trial = state if stage == 0 else memory.predicted
            rate = memory.first if stage == 0 else memory.second
            if stage == 1:
                pairs = refresh_neighbours(model, pairs, trial[X], trial[Y])
            rates(model, trial, pairs, amplitude_rate, work, rate)
            constrain(model, rate, work)
            if stage == 0:
                for row in range(STATE_ROWS):
                    for i in range(state.shape[1]):
                        memory.predicted[row, i] = state[row, i] + dt * rate[row, i]
        for row in range(STATE_ROWS):
            for i in range(state.shape[1]):
                state[row, i] += 0.5 * dt * (memory.first[row, i] + memory.second[row, i])
    return end, is_sound(state, speed_limit), pairs
