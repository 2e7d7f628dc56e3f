"""Explicit stepping with Heun's method: predictor and trapezoidal corrector (thesis 2.6).

No Python runs inside the time loop. The loop is called in chunks; everything that one step hands to
the next lives in the arrays passed, so that chunking changes no bit of the result. Between chunks the
caller renews the neighbour list when told so, which depends on the state alone.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled, compiled_inner
from sphstudy.numerics.sph.neighbours import look, outdated
from sphstudy.numerics.sph.updated_lagrangian import (
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
    fastest,
    rates,
    workspace,
)

CHECK_INTERVAL = 50
"""Steps between two looks at whether the run is still sound."""

REACHED, UNSOUND, OUTDATED = range(3)
"""Why `advance` returned: the end, a state that is not sound, a neighbour list that needs renewal."""


class Buffers(NamedTuple):
    """What one step needs besides the state: predicted state, the two derivatives, workspace."""

    predicted: np.ndarray
    first: np.ndarray
    second: np.ndarray
    work: Workspace


def buffers(model: Model, count: int, threads: int = 1) -> Buffers:
    """Buffers for `count` particles, summed by `threads` threads."""
    predicted, first, second = (np.zeros((STATE_ROWS, count)) for _ in range(3))
    return Buffers(predicted, first, second, workspace(model, count, threads))


@compiled_inner
def is_sound(state, bulk_modulus):
    """Whether everything is finite, all densities are positive, and nothing outruns sound, c² = K/ρ."""
    for i in range(state.shape[1]):
        total = 0.0
        for row in range(STATE_ROWS):
            total += state[row, i]
        if not (np.isfinite(total) and state[RHO, i] > 0.0):
            return False
        if not (state[VX, i] ** 2 + state[VY, i] ** 2) * state[RHO, i] <= bulk_modulus:
            return False
    return True


@compiled
def advance(model, state, pairs, memory, amplitude_rate, dt, begin, end):
    """Steps from number `begin` to `end`; returns (steps taken in all, why it returned).

    `state` [8, N] is updated in place. Prescribed freedoms move with target · `amplitude_rate`. Before a
    step in which the neighbour list might miss a pair, and every CHECK_INTERVAL steps if the state is not
    sound, stepping ends.
    """
    work, predicted, first, second = memory.work, memory.predicted, memory.first, memory.second
    for step in range(begin, end):
        if step % CHECK_INTERVAL == 0 and not is_sound(state, model.bulk_modulus):
            return step, UNSOUND
        if outdated(pairs, state[X], state[Y], dt * fastest(model, state, amplitude_rate)):
            return step, OUTDATED
        look(pairs, state[X], state[Y], model.crack)
        begin_step(model.smoothing, model, state, pairs, amplitude_rate, work)
        for stage in range(2):
            trial = state if stage == 0 else predicted
            rate = first if stage == 0 else second
            if stage == 1:
                look(pairs, trial[X], trial[Y], model.crack)
            rates(model, trial, pairs, amplitude_rate, work, rate)
            constrain(model, rate, work)
            if stage == 0:
                for row in range(STATE_ROWS):
                    for i in range(state.shape[1]):
                        predicted[row, i] = state[row, i] + dt * rate[row, i]
        for row in range(STATE_ROWS):
            for i in range(state.shape[1]):
                state[row, i] += 0.5 * dt * (first[row, i] + second[row, i])
    return end, REACHED if is_sound(state, model.bulk_modulus) else UNSOUND
