"""Sums over pairs by blocks: every pair once, and the same bits for any number of threads."""

import numba
import numpy as np
import pytest

from sphstudy.model.material import Material
from sphstudy.numerics.sph import (
    bond_sums,
    constitutive,
    kernel,
    neighbours,
    total_lagrangian,
    updated_lagrangian,
)
from sphstudy.numerics.sph.pair_blocks import begins
from sphstudy.numerics.sph.updated_lagrangian import rates, workspace
from tests.numerics.sph import brute_force
from tests.numerics.sph.clouds import (
    FREE,
    lattice_positions,
    middle_crack,
    model,
    random_cloud,
    random_state,
)


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch):
    """So that a small body has many blocks."""
    monkeypatch.setattr(neighbours, "BLOCK", 8)


def bodies(rng):
    lattice = lattice_positions(9, 14)
    sorted_cloud = random_cloud(rng, 100)
    rows = np.lexsort((sorted_cloud[0], np.round(sorted_cloud[1])))
    return {
        "lattice": lattice,
        "nearly": lattice + rng.uniform(-0.05, 0.05, lattice.shape),
        "cloud": sorted_cloud[:, rows],
    }


every_body = pytest.mark.parametrize("body", ["lattice", "nearly", "cloud"])


def test_blocks_begin_where_their_first_item_stands():
    np.testing.assert_array_equal(begins(np.array([0, 3, 9, 9, 31]), 8, 40), [0, 2, 4, 4, 5, 5])


@every_body
def test_no_pair_reaches_beyond_the_next_block(rng, body):
    positions = bodies(rng)[body]
    pairs = neighbours.build(*positions, 3.0, 0.1, None)
    first, second = neighbours.as_pairs(pairs)
    size = neighbours.block_size(*neighbours.close_pairs(*positions, 3.1))
    assert pairs.run_begin.size - 1 == -(-positions.shape[1] // size)
    assert pairs.run_begin.size > 3, "the body should have several blocks"
    assert (second // size - first // size <= 1).all()
    for begin, of in ((pairs.run_begin, pairs.start), (pairs.single_begin, pairs.first)):
        for block in range(begin.size - 1):
            assert (of[begin[block] : begin[block + 1]] // size == block).all()
    last = pairs.start + pairs.length - 1
    np.testing.assert_array_equal(last // size, pairs.start // size)


def derivative(rng, positions, threads):
    made, state = model(rng, positions), random_state(rng, positions)
    pairs = updated_lagrangian.build_neighbours(made, state)
    neighbours.look(pairs, state[0], state[1], made.crack)
    rate = np.zeros_like(state)
    rates(made, state, pairs, 0.0, workspace(made, state.shape[1], threads), rate)
    return made, state, rate


@every_body
def test_rates_are_those_of_the_brute_force_twin(body):
    rng = np.random.default_rng(3)
    made, state, rate = derivative(rng, bodies(rng)[body], 1)
    for found, expected in zip(rate, brute_force.rates(made, state)[0], strict=True):
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())


def elastic(positions):
    return total_lagrangian.model(
        *positions,
        np.ones(positions.shape[1]),
        1.0,
        kernel.KERNELS["cubic"],
        1.3,
        constitutive.law("svk", Material(10.0, 0.3, 1.0, "strain")),
        FREE,
        crack=middle_crack(positions),
    )


def internal_force(rng, positions, threads):
    count, made = positions.shape[1], elastic(positions)
    moved = positions + rng.uniform(-0.1, 0.1, positions.shape)
    force = np.zeros_like(positions)
    total_lagrangian.force(made, *moved, total_lagrangian.workspace(count, threads), force)
    return force


@pytest.mark.compiled
@pytest.mark.slow
@every_body
def test_two_threads_change_no_bit(body):
    if numba.config.NUMBA_NUM_THREADS > 1:
        numba.set_num_threads(2)
    one, two = (np.random.default_rng(5) for _ in range(2))
    positions, again = bodies(one)[body], bodies(two)[body]
    serial, parallel = derivative(one, positions, 1)[2], derivative(two, again, 2)[2]
    assert np.abs(serial).max() > 0.0
    np.testing.assert_array_equal(serial, parallel)
    serial, parallel = internal_force(one, positions, 1), internal_force(two, again, 2)
    assert np.abs(serial).max() > 0.0
    np.testing.assert_array_equal(serial, parallel)


@pytest.mark.compiled
def test_no_optional_number_goes_to_threads(rng):
    """On its way to them Numba loses whether it is there, in one process out of many."""
    positions = bodies(rng)["lattice"]
    # Compiled afresh: what is loaded from the cache does not tell what it hands on.
    fresh = numba.njit(error_model="numpy")(total_lagrangian.force.py_func)
    work = total_lagrangian.workspace(positions.shape[1], 2)
    fresh(elastic(positions), *positions, work, np.zeros_like(positions))
    assert bond_sums.forces.signatures
    handed = [one for signature in bond_sums.forces.signatures for one in signature]
    assert not any(isinstance(one, numba.types.Optional) for one in handed)
