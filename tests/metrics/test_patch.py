"""Errors of a patch on displacements with known answers."""

import numpy as np
import pytest

from sphstudy.metrics import patch as metric
from sphstudy.model.scenes import patch
from sphstudy.numerics.solvers.solution import Snapshot, Solution
from sphstudy.store.record import fields
from tests.model.scenes.test_tension import configured


def followed():
    """Record of a patch in which all particles follow the frame, its places and its gradient."""
    config = configured("scene=patch")
    problem = patch.build(config)
    place, gradient = np.stack((problem.body.x, problem.body.y)), config.scene.gradient
    state = np.zeros((8, place.shape[1]))
    state[:2] = place + gradient @ place
    solution = Solution(snapshots=[Snapshot("settle", 0.0, 0, state, 0.0)])
    return fields(problem, solution), config, place, gradient


def values(run, config):
    return {name: found.value for name, found in metric.measure(run, config).items()}


def test_who_follows_the_frame_has_no_error():
    run, config, *_ = followed()
    found = values(run, config)
    assert len(found) == 4
    for name, value in found.items():
        assert value == pytest.approx(0.0, abs=1e-11), name


def test_one_particle_off_is_the_largest_error_and_a_share_of_the_mean_square():
    run, config, place, gradient = followed()
    free = run["tag_frame"].values == 0
    largest = np.hypot(*(gradient @ place)).max()
    inside = int(np.argmin(np.hypot(*place)))
    run["y"].values[0, inside] += 0.2 * largest
    found = values(run, config)
    assert found["displacement_error"] == pytest.approx(0.2)
    assert found["displacement_error_rms"] == pytest.approx(0.2 / np.sqrt(free.sum()))
    assert found["strain_error"] > found["strain_error_rms"] > 0.0
    run["x"].values[0, ~free] += largest
    assert values(run, config)["displacement_error"] == pytest.approx(0.2)


def test_another_gradient_is_an_error_of_strain():
    run, config, place, gradient = followed()
    other = np.array([[0.0, -3e-4], [2e-4, 1e-4]])
    run["x"].values[0] += other[0] @ place
    run["y"].values[0] += other[1] @ place
    expected = np.linalg.norm(other) / np.linalg.norm(gradient)
    found = values(run, config)
    assert found["strain_error"] == pytest.approx(expected, rel=1e-9)
    assert found["strain_error_rms"] == pytest.approx(expected, rel=1e-9)


def test_gradient_of_a_quadratic_displacement_is_exact_inside_a_lattice():
    """By symmetry of the neighbours, which the edge lacks."""
    line = np.arange(9.0)
    place = np.stack([axis.ravel() for axis in np.meshgrid(line, line)])
    x, y = place
    moved = np.stack((0.1 * x * x - 0.2 * x * y, 0.3 * y * y + 0.5 * x))
    found = metric.displacement_gradients(place, moved, 2.3)
    inside = (np.abs(place - 4.0) < 2.5).all(axis=0)
    exact = np.stack([np.stack((0.2 * x - 0.2 * y, -0.2 * x)), np.stack((0.5 + 0 * x, 0.6 * y))])
    np.testing.assert_allclose(found[:, :, inside], exact[:, :, inside], atol=1e-12)
    assert np.abs(found - exact)[:, :, ~inside].max() > 0.1
