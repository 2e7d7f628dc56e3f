"""The compiled right-hand side against its brute-force twin, term by term, and its conservation laws."""

import itertools

import numpy as np
import pytest

from sphstudy.model.constraints import Constraints
from sphstudy.numerics.sph import updated_lagrangian
from sphstudy.numerics.sph.neighbours import look
from sphstudy.numerics.sph.updated_lagrangian import begin_step, constrain, rates, workspace
from tests.numerics.sph import brute_force
from tests.numerics.sph.clouds import TERMS, lattice_positions, model, random_cloud, random_state

ALL = [c for k in range(len(TERMS) + 1) for c in itertools.combinations(TERMS, k)]


def build_neighbours(made, state):
    """A list that is up to date with the state."""
    pairs = updated_lagrangian.build_neighbours(made, state)
    look(pairs, state[0], state[1], made.crack)
    return pairs


def evaluate(made, state, amplitude_rate=0.0):
    pairs = build_neighbours(made, state)
    work = workspace(made, state.shape[1])
    rate = np.full_like(state, np.nan)
    rates(made, state, pairs, amplitude_rate, work, rate)
    return rate, work, pairs


def assert_close(computed, expected):
    for row, (one, other) in enumerate(zip(computed, expected, strict=True)):
        scale = np.abs(other).max()
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-12 * scale, err_msg=f"row {row}")


@pytest.mark.parametrize("terms", [TERMS, ()], ids=["all terms", "no terms"])
def test_equals_the_brute_force_twin_on_a_random_cloud_with_a_crack(rng, terms):
    positions = random_cloud(rng)
    made, state = model(rng, positions, terms), random_state(rng, positions)
    rate, *_ = evaluate(made, state)
    assert_close(rate, brute_force.rates(made, state)[0])


def test_equals_the_brute_force_twin_on_a_moving_lattice(rng):
    """A lattice works in runs, a cloud in singles: the same physics must come out of both."""
    positions = lattice_positions(14, 6)
    made, state = model(rng, positions, TERMS), random_state(rng, positions)
    state[:2] += rng.uniform(-0.05, 0.05, (2, positions.shape[1]))
    rate, _, pairs = evaluate(made, state)
    assert pairs.start.size > 0
    assert_close(rate, brute_force.rates(made, state)[0])


@pytest.mark.interpreted
@pytest.mark.parametrize("terms", ALL, ids=["+".join(c) or "none" for c in ALL])
def test_equals_the_brute_force_twin_term_by_term(rng, terms):
    positions = random_cloud(rng, 40)
    made, state = model(rng, positions, terms), random_state(rng, positions)
    rate, *_ = evaluate(made, state)
    assert_close(rate, brute_force.rates(made, state)[0])


@pytest.mark.interpreted
@pytest.mark.parametrize("shape", ["wendland", "quintic"])
def test_equals_the_brute_force_twin_with_other_kernels(rng, shape):
    positions = random_cloud(rng, 40)
    made, state = model(rng, positions, shape=shape), random_state(rng, positions)
    rate, *_ = evaluate(made, state)
    assert_close(rate, brute_force.rates(made, state)[0])


def test_internal_forces_keep_linear_momentum_to_round_off(rng):
    positions = random_cloud(rng)
    made, state = model(rng, positions), random_state(rng, positions)
    rate, *_ = evaluate(made, state)
    force = made.mass * rate[2:4]
    assert np.abs(force.sum(axis=1)).max() < 1e-14 * np.abs(force).sum()


def test_artificial_viscosity_only_takes_energy(rng):
    """Without stress the only force is viscous: its power is never positive, and not always zero."""
    positions = random_cloud(rng)
    made = model(rng, positions, ("viscosity", "crack"))
    powers = []
    for _ in range(50):
        state = random_state(rng, positions)
        state[5:] = 0.0
        rate, *_ = evaluate(made, state)
        powers.append(np.sum(made.mass * (state[2] * rate[2] + state[3] * rate[3])))
    assert max(powers) < 0.0


def test_viscosity_rests_when_particles_separate(rng):
    positions = random_cloud(rng)
    made, state = model(rng, positions, ("viscosity",)), random_state(rng, positions)
    state[5:] = 0.0
    state[2:4] = positions - positions.mean(axis=1, keepdims=True)
    rate, *_ = evaluate(made, state)
    assert np.abs(rate[2:4]).max() == 0.0


def test_rigid_translation_and_pressure_free_body_feel_nothing(rng):
    positions = random_cloud(rng)
    made, state = model(rng, positions), random_state(rng, positions)
    state[2], state[3], state[5:] = 3.0, -2.0, 0.0
    rate, *_ = evaluate(made, state)
    np.testing.assert_allclose(rate[0], 3.0, rtol=1e-15)
    assert np.abs(rate[2:]).max() < 1e-14


def test_constraints_prescribe_velocity_smoothed_velocity_and_leave_no_acceleration(rng):
    positions = random_cloud(rng)
    held = np.array([3, 17, 25])
    target = np.array([0.5, -1.0, 2.0])
    constraints = Constraints(held, target, held[:2], target[:2])
    made = model(rng, positions, constraints=constraints, damping=0.4, smoothing=0.7)
    state = random_state(rng, positions)
    pairs, work = build_neighbours(made, state), workspace(made, positions.shape[1])
    begin_step(made.smoothing, made, state, pairs, 2.0, work)
    rate = np.zeros_like(state)
    rates(made, state, pairs, 2.0, work, rate)
    constrain(made, rate, work)
    np.testing.assert_array_equal(state[2, held], 2.0 * target)
    np.testing.assert_array_equal(rate[0, held], 2.0 * target)
    np.testing.assert_array_equal(rate[1, held[:2]], 2.0 * target[:2])
    np.testing.assert_array_equal(rate[2, held], 0.0)
    np.testing.assert_array_equal(rate[3, held[:2]], 0.0)
    assert rate[3, held[2]] != 0.0


def test_smearing_and_damping_follow_their_equations(rng):
    positions = random_cloud(rng)
    made, state = model(rng, positions, damping=0.4, smoothing=0.7), random_state(rng, positions)
    before = state.copy()
    _, smoothed = brute_force.rates(made, before)
    pairs, work = build_neighbours(made, state), workspace(made, positions.shape[1])
    begin_step(made.smoothing, made, state, pairs, 0.0, work)
    np.testing.assert_allclose(state[2:4], 0.3 * before[2:4] + 0.7 * smoothed, atol=1e-13)
    rate = np.zeros_like(state)
    rates(made, state, pairs, 0.0, work, rate)
    undamped, smoothed = brute_force.rates(made, state)
    constrain(made, rate, work)
    np.testing.assert_allclose(rate[2:4], undamped[2:4] - 0.4 * smoothed, atol=1e-12)


@pytest.mark.interpreted
def test_stress_turns_with_a_rigid_rotation_by_jaumanns_rate(rng):
    """Inside a lattice that spins at Ω the rate of stress is Ω (Rσ - σR), but for the factor by which the
    uncorrected gradient misses a linear field.
    """
    positions = lattice_positions(15, 15)
    made, state = model(rng, positions, ("spin",)), random_state(rng, positions)
    made = made._replace(mass=np.ones(225))
    state[4], state[5], state[6], state[7] = 1.0, 2.0, -1.0, 0.5
    state[2], state[3] = -0.3 * (positions[1] - 7.0), 0.3 * (positions[0] - 7.0)
    rate, *_ = evaluate(made, state)
    middle, still = 112, 0.3 * np.array([-2.0 * 0.5, 2.0 * 0.5, 2.0 + 1.0])
    found = rate[5:, middle] / still
    np.testing.assert_allclose(found, found[0], rtol=1e-12)
    assert found[0] == pytest.approx(1.0, abs=0.05)
