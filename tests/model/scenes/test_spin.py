"""The spinning square: how it is set up, and what becomes of it without the terms of the spin."""

import numpy as np
import pytest

import sphstudy
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.model.scenes import spin


def config_of(*overrides):
    with session() as hydra:
        return hydra.points(["scene=spin", *overrides], sweep=False)[0][0].config


def test_square_spins_rigidly_about_its_centre():
    problem = spin.build(config_of("n=8", "scene.turns=3"))
    body, mass = problem.body, problem.body.mass
    assert body.x.size == spin.particles(config_of("n=8")) == 64
    assert mass.sum() == pytest.approx(1100.0)
    centre = [float(mass @ body.x), float(mass @ body.y)]
    np.testing.assert_allclose(centre, 0.0, atol=1e-10)
    radius = np.hypot(body.x, body.y)
    along = body.x * problem.velocity_x + body.y * problem.velocity_y
    np.testing.assert_allclose(along, 0.0, atol=1e-12)
    spun = body.x * problem.velocity_y - body.y * problem.velocity_x
    np.testing.assert_allclose(spun, 50.0 * radius**2)
    assert problem.stages[0].duration == pytest.approx(3.0 * 2.0 * np.pi / 50.0)
    assert body.x[problem.tracked] == body.x.max() == pytest.approx(0.5 - 1.0 / 16.0)
    assert problem.constraints.x_index.size == problem.constraints.y_index.size == 0
    assert problem.constraints.x_index.dtype == np.int64


def test_an_objective_law_is_the_protocol_of_the_total_lagrangian_method():
    assert config_of("method=tl").method.law == "neohookean"


def test_too_few_particles_are_refused():
    with pytest.raises(ConfigurationError, match="n=2: must be at least 3 in spin"):
        config_of("n=2", "h=0.9")


@pytest.mark.slow
def test_rotation_is_kept_by_the_potential_and_lost_by_a_rate_without_spin(tmp_path):
    common = {"scene": "spin", "n": 10, "results": tmp_path, "scene.turns": 2}
    sound = sphstudy.run(method="tl", **common)
    assert float(sound["angular_momentum_drift"]) < 1e-13
    assert float(sound["energy_drift"]) < 3e-5
    assert abs(float(sound["rate_error"])) < 1e-3
    assert 0.004 < float(sound["corner_stretch_largest"]) < 0.014
    assert float(sound["fourfold_defect"]) < 1e-11
    lost = sphstudy.run(method="thesis", **common)
    assert float(lost["angular_momentum_drift"]) > 0.1
    assert float(lost["turns"]) < 1.0
