"""Modes against dense algebra, and what they tell of the initial motion and of modes without energy."""

import numpy as np
import pytest
import scipy.linalg

from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import session
from sphstudy.metrics import oscillation
from sphstudy.numerics.solvers import modes
from sphstudy.numerics.sph import stiffness
from sphstudy.store.record import fields


def solved(*settings):
    with session() as hydra:
        (point,), _ = hydra.points(["scene=plate", "method=tl", "solve=modes", *settings], sweep=False)
    config, problem = point.config, scene_module("plate").build(point.config)
    return modes.run(problem, config, method_module(config.method.kind), lambda *_: None), problem, config


def test_modes_are_those_of_dense_algebra():
    solution, problem, config = solved("n=3", "h=1.3")
    model = method_module(config.method.kind).model(problem, config, 0)
    unit = np.tile([[1.0], [0.0], [0.0], [1.0]], model.x.size)
    dense = stiffness.tangent(model, stiffness.operators(model), unit).toarray()
    held = np.concatenate((model.constraints.x_index, model.x.size + model.constraints.y_index))
    free = np.setdiff1d(np.arange(2 * model.x.size), held)
    squares = scipy.linalg.eigh(
        dense[np.ix_(free, free)], np.diag(np.tile(model.mass, 2)[free]), eigvals_only=True
    )
    found = solution.variables["mode_frequency"].values
    np.testing.assert_allclose(found, np.sqrt(squares[: found.size]), rtol=1e-9)


def test_shapes_solve_the_eigenproblem_hold_the_clamp_and_are_orthogonal():
    solution, problem, config = solved("n=5", "h=1.5")
    model = method_module(config.method.kind).model(problem, config, 0)
    found = solution.variables
    shapes = np.concatenate((found["mode_shape_x"].values, found["mode_shape_y"].values), axis=1)
    mass = np.tile(model.mass, 2)
    np.testing.assert_allclose(shapes @ (mass[:, None] * shapes.T), np.eye(len(shapes)), atol=1e-10)
    unit = np.tile([[1.0], [0.0], [0.0], [1.0]], model.x.size)
    stiff = stiffness.tangent(model, stiffness.operators(model), unit)
    free = np.ones(mass.size, bool)
    free[model.constraints.x_index] = free[model.x.size + model.constraints.y_index] = False
    assert (shapes[:, ~free] == 0.0).all()
    left = (stiff @ shapes.T - mass[:, None] * shapes.T * found["mode_frequency"].values ** 2)[free]
    assert np.abs(left).max() < 1e-6 * np.abs(stiff @ shapes.T).max()
    assert found["mode_residual"].values.max() < 1e-6
    assert found["mode_orthogonality"].values < 1e-12


def test_shares_of_the_initial_energy_add_up_to_one():
    solution = solved("n=3", "h=1.3", "solve.count=120")[0]
    shares = solution.variables["mode_participation"].values
    assert shares.sum() <= 1.0 + 1e-12
    assert shares[0] > 0.99
    assert shares.sum() > 0.9999


def test_modes_without_energy_lie_below_the_first_without_the_hourglass_term():
    solution, problem, config = solved("n=5", "h=1.9", "method.hourglass=0", "solve.count=60")
    metrics = oscillation.measure(fields(problem, solution), config)
    spurious = int(metrics["spurious_modes"].value)
    assert spurious > 0
    omega = solution.variables["mode_frequency"].values
    assert omega[0] < 0.2 * metrics["frequency_2d"].value
    assert metrics["frequency"].value == omega[spurious]
    cured, problem, config = solved("n=5", "h=1.9")
    assert oscillation.measure(fields(problem, cured), config)["spurious_modes"].value == 0.0


def test_a_fundamental_mode_that_was_not_found_is_said():
    solution, problem, config = solved("n=9", "h=1.9", "method.hourglass=0", "solve.count=2")
    metrics = oscillation.measure(fields(problem, solution), config)
    assert np.isnan(metrics["frequency"].value)
    assert "none of the 2 lowest modes" in metrics["frequency"].remark
    assert metrics["spurious_modes"].value == 2.0


@pytest.mark.parametrize(("n", "bound"), [(9, 0.017), (15, 0.0055), (21, 0.0025)])
def test_plate_frequency_against_two_dimensional_elasticity(n, bound):
    solution, problem, config = solved("h=1.3", f"n={n}")
    metrics = oscillation.measure(fields(problem, solution), config)
    assert abs(metrics["frequency_error_2d"].value) < bound
    assert abs(metrics["second_frequency_error_2d"].value) < bound
    assert metrics["frequency_2d_uncertainty"].value < 0.1 * bound
