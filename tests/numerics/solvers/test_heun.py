"""The time loop: one step against its equations, chunking, repeatability, order, and blow-ups."""

from itertools import pairwise

import numpy as np
import pytest

from sphstudy.numerics.solvers.heun import CHECK_INTERVAL, OUTDATED, UNSOUND, advance, buffers
from sphstudy.numerics.sph.updated_lagrangian import build_neighbours, fastest
from tests.numerics.sph import brute_force
from tests.numerics.sph.clouds import lattice_positions, model, random_state


@pytest.fixture
def body(rng):
    positions = lattice_positions(12, 6)
    # Smooth terms only: visibility and viscosity switch, which costs Heun's method its order.
    made = model(rng, positions, ("xsph",), damping=0.3)
    state = random_state(rng, positions)
    state[2:4] *= 0.05
    state[4] = 1.0
    state[5:] *= 0.05
    return made, state


def stepped(made, state, dt, chunks, begin=0):
    """State, steps taken and whether it is still sound, after stepping in these chunks."""
    state = state.copy()
    pairs, memory = build_neighbours(made, state), buffers(made, state.shape[1])
    for end in chunks:
        while begin < end:
            begin, reason = advance(made, state, pairs, memory, 0.0, dt, begin, end)
            if reason == OUTDATED:
                pairs = build_neighbours(made, state, dt * fastest(made, state, 0.0))
            if reason == UNSOUND or pairs is None:
                return state, begin, False
    return state, begin, True


def test_one_step_is_predictor_and_trapezoidal_corrector(body):
    made, state = body
    dt = 0.01

    def rates(at):
        derivative, smoothed = brute_force.rates(made, at)
        derivative[2:4] -= 0.3 * smoothed
        return derivative

    first = rates(state)
    second = rates(state + dt * first)
    computed, *_ = stepped(made, state, dt, [1])
    np.testing.assert_allclose(computed, state + 0.5 * dt * (first + second), rtol=0, atol=1e-13)


def test_chunking_changes_no_bit(body):
    made, state = body
    whole, *_ = stepped(made, state, 0.01, [300])
    pieces, *_ = stepped(made, state, 0.01, [1, 2, 50, 51, 117, 299, 300])
    assert np.abs(whole[:2] - state[:2]).max() > 0.15, "the neighbour list should have been rebuilt"
    np.testing.assert_array_equal(whole, pieces)


def test_the_same_run_twice_is_identical_to_the_last_bit(body):
    made, state = body
    np.testing.assert_array_equal(*(stepped(made, state, 0.01, [200])[0] for _ in range(2)))


def test_second_order_in_time(body):
    made, state = body
    end = 0.08
    results = [stepped(made, state, end / n, [n])[0] for n in (8, 16, 32, 64)]
    gaps = [np.abs(a - b).max() for a, b in pairwise(results)]
    orders = np.log2(np.array(gaps[:-1]) / gaps[1:])
    assert orders[-1] == pytest.approx(2.0, abs=0.25)


@pytest.mark.parametrize(("row", "value"), [(0, np.nan), (2, np.inf), (7, np.nan), (4, -1.0), (3, 5e3)])
def test_a_blow_up_is_noticed_within_a_hundred_steps(body, row, value):
    made, state = body
    bad, step, sound = stepped(made, state, 0.001, [30])
    assert sound
    assert step == 30
    bad[row, 20] = value
    _, reached, sound = stepped(made, bad, 0.001, [10_000], begin=30)
    assert not sound
    assert reached - 30 <= min(100, CHECK_INTERVAL)


def test_an_unstable_step_ends_by_itself(body):
    made, state = body
    _, step, sound = stepped(made, state, 5.0, [100_000])
    assert not sound
    assert step <= 200


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("row", range(8))
def test_what_is_not_finite_ends_the_run_at_the_check(body, row, value):
    made, state = body
    state[row, 17] = value
    pairs, memory = build_neighbours(made, state), buffers(made, state.shape[1])
    assert advance(made, state, pairs, memory, 0.0, 0.01, 0, 60) == (0, UNSOUND)
