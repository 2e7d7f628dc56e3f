"""What a collision leaves, from records made by hand."""

import numpy as np
import pytest

from sphstudy.metrics import collision
from sphstudy.model.scenes import rings
from sphstudy.numerics.solvers.indicators import cells
from sphstudy.numerics.solvers.solution import FIELDS, HISTORY, Snapshot, Solution
from sphstudy.store.record import fields
from tests.model.scenes.test_tension import configured


def record(rebound=0.0, stretched=1.0):
    """Rings that have turned round with this share of their speed, the right one stretched in x."""
    config = configured("scene=rings", "n=4")
    problem = rings.build(config)
    body, state = problem.body, np.zeros((len(FIELDS), problem.body.x.size))
    state[:2] = body.x, body.y
    state[0, ~body.tags["left"]] *= stretched
    state[2] = -rebound * problem.velocity_x
    history = [(0.0,) * len(HISTORY)]
    return fields(problem, Solution([Snapshot("collide", 1.0, 1, state, 0.0)], history)), config


def values(run, config):
    return {name: found.value for name, found in collision.measure(run, config).items()}


def test_rebound_is_speed_after_over_before():
    assert values(*record(rebound=0.7))["rebound"] == pytest.approx(0.7)


def test_bonds_are_edges_and_diagonals_of_the_cells_of_both_rings():
    run, config = record()
    corners = cells(rings.build(config).body)
    ends = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    pairs = {tuple(sorted(pair)) for a, b in ends for pair in zip(corners[a], corners[b], strict=True)}
    found = values(run, config)
    assert found["bonds"] == len(pairs)
    assert found["longest_bond"] == pytest.approx(1.0)
    assert found["broken_bonds"] == 0.0


def test_bonds_along_the_stretch_of_one_ring_are_broken():
    found = values(*record(stretched=2.5))
    assert found["longest_bond"] == pytest.approx(2.5)
    assert 0.0 < found["broken_bonds"] < 0.5 * found["bonds"]
