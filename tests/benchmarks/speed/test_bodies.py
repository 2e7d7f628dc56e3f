"""Systems to be timed: the same body however its particles are arranged; terms that are truly gone."""

import numpy as np
import pytest

from sphstudy.benchmarks.speed import cases
from sphstudy.benchmarks.speed.bodies import (
    LATTICE,
    PERTURBATION,
    PERTURBED,
    SHUFFLED,
    Case,
    arranged,
    interacting_pairs,
    made,
)
from sphstudy.catalogue import scene_module
from sphstudy.configuration.composition import session


@pytest.fixture(scope="module")
def hydra():
    with session() as opened:
        yield opened


@pytest.fixture(scope="module")
def square(hydra):
    config = hydra.points(["scene=mode1", "n=20"], sweep=False)[0][0].config
    return config, scene_module("crack").build(config)


@pytest.mark.parametrize("arrangement", [LATTICE, PERTURBED, SHUFFLED])
def test_an_arrangement_keeps_masses_constraints_and_crack_with_their_particles(square, arrangement):
    _, problem = square
    found = arranged(problem, arrangement)
    body, held = found.body, found.constraints
    near = PERTURBATION * problem.body.spacing_x * (1.0 + 1e-12)
    for index, before in (
        (held.x_index, problem.constraints.x_index),
        (found.crack_first, problem.crack_first),
        (found.crack_second, problem.crack_second),
        (np.array([found.tracked]), np.array([problem.tracked])),
    ):
        assert np.abs(body.x[index] - problem.body.x[before]).max() <= near
        assert np.abs(body.y[index] - problem.body.y[before]).max() <= near
    np.testing.assert_array_equal(np.sort(np.flatnonzero(body.tags["frame"])), np.sort(held.x_index))
    in_order = np.mean(np.diff(body.y) > -2.0 * near)
    assert in_order == 1.0 if arrangement != SHUFFLED else in_order < 0.8


def test_pairs_are_counted_as_they_interact(square):
    config, problem = square
    apart = np.hypot(*(np.subtract.outer(v, v) for v in (problem.body.x, problem.body.y)))
    within = apart < 2.0 * config.h * problem.body.mean_spacing * (1.0 - 1e-9)
    assert interacting_pairs(problem, config) == (np.count_nonzero(within) - within.shape[0]) // 2


@pytest.mark.slow
@pytest.mark.parametrize("method", ["thesis", "tl"])
def test_a_term_switched_off_makes_the_model_that_never_had_it(hydra, method):
    """The types of its fields are what compiled code is specialised by."""
    chosen = [case for case in cases.terms(20) if case.label.startswith(method)]
    models = {(case.term, case.variant): made(hydra, case).system.model for case in chosen}
    for term in {case.term for case in chosen} - {""}:
        off, never = models[term, "off"], models[term, "never"]
        types = [[type(value) for value in model] for model in (off, never, models["", "all"])]
        assert types[0] == types[1]
        assert types[0] != types[2]


def test_a_case_begins_where_its_scene_begins(hydra):
    one = made(hydra, Case("tl, plate", "forms", ("scene=plate", "n=5", "method=tl", "h=1.3")))
    assert (one.particles, one.evaluations) == (12 * 25, 1)
    assert one.system.pairs == one.interacting
