"""Sharp loads: how they are set up, and what of them stays."""

import numpy as np
import pytest

import sphstudy
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.model.exact.waves import longitudinal_speed
from sphstudy.model.scenes import sharp


def config_of(scene, *overrides):
    with session() as hydra:
        return hydra.points([f"scene={scene}", *overrides], sweep=False)[0][0].config


@pytest.mark.parametrize("layers", [1, 3])
def test_bar_flies_towards_its_held_end(layers):
    config = config_of("sharp_wave", "n=5", f"scene.held_layers={layers}")
    problem = sharp.build(config)
    body, held = problem.body, problem.body.tags["held"]
    assert body.x.size == sharp.particles(config) == 5 * (50 + layers - 1)
    assert held.sum() == 5 * layers
    assert body.x[held].max() == 0.0
    assert body.x.max() == pytest.approx(1.0 - 1.0 / 50.0)
    sound = longitudinal_speed(body.material)
    np.testing.assert_allclose(problem.velocity_x, np.where(held, 0.0, -0.01 * sound))
    assert not problem.velocity_y.any()
    assert problem.constraints.x_index.tolist() == np.flatnonzero(held).tolist()
    assert problem.constraints.y_index.size == body.x.size
    assert problem.stages[0].duration == pytest.approx(0.6 / sound)
    assert body.y[problem.tracked] == 0.0
    assert problem.displacement_x is None


def test_middle_particle_of_the_square_is_displaced_and_nothing_moves():
    config = config_of("sharp_particle", "n=9")
    problem = sharp.build(config)
    body, moved = problem.body, problem.displacement_x
    assert body.x.size == sharp.particles(config) == 81
    assert np.flatnonzero(moved).tolist() == [40] == [problem.tracked]
    assert moved[40] == pytest.approx(0.2 / 9.0)
    assert body.x[40] == body.y[40] == 0.0
    assert problem.displacement_y is None
    assert not problem.velocity_x.any()
    assert not problem.velocity_y.any()
    inside = ~body.tags["held"].reshape(9, 9)
    assert inside.sum() == 25
    assert inside[2:7, 2:7].all()
    assert problem.constraints.y_index.tolist() == np.flatnonzero(~inside).tolist()
    assert problem.stages[0].duration == pytest.approx(20.0 / longitudinal_speed(body.material))


@pytest.mark.parametrize(
    ("scene", "override", "complaint"),
    [
        ("sharp_wave", "n=6", "n=6: must be odd in sharp_wave"),
        ("sharp_wave", "scene.crossings=1.0", "scene.crossings=1: below 1 in sharp_wave"),
        ("sharp_particle", "scene.slenderness=2", "scene.slenderness=2: sharp_particle is a square"),
        ("sharp_particle", "n=5", "n=5: must be at least 7 in sharp_particle"),
    ],
)
def test_settings_that_make_no_scene_are_refused(scene, override, complaint):
    with pytest.raises(ConfigurationError, match=complaint):
        config_of(scene, override)


@pytest.mark.slow
def test_step_load_rings_behind_its_front_without_viscosity_and_dissipates_with_it(tmp_path):
    common = {"scene": "sharp_wave", "n": 9, "h": 1.3, "results": tmp_path}
    noisy = sphstudy.run(method="tl", **common)
    assert abs(float(noisy["plateau_stress_error"])) < 0.02
    assert abs(float(noisy["front_lag"])) < 2.0
    assert 0.2 < float(noisy["stress_overshoot"]) < 0.34
    assert 1.0 < float(noisy["plateau_noise_ratio"]) < 3.0
    assert float(noisy["energy_drift"]) < 1e-3
    smooth = sphstudy.run(method="thesis", **common)
    assert float(smooth["plateau_noise_ratio"]) < 1.0
    assert float(smooth["stress_overshoot"]) < 0.2
    assert float(smooth["dissipated_energy"]) > 0.01


@pytest.mark.slow
def test_displaced_particle_spreads_its_energy_unless_stress_knows_no_displacement(tmp_path):
    common = {"scene": "sharp_particle", "n": 11, "h": 1.3, "results": tmp_path}
    spread = sphstudy.run(method="tl", **common)
    assert float(spread["offset_left"]) < 0.3
    assert float(spread["hourglass_left"]) == pytest.approx(np.sqrt(0.5), abs=0.1)
    assert float(spread["energy_drift"]) < 0.01
    forgotten = sphstudy.run(method="thesis", **common)
    assert float(forgotten["offset_left"]) == pytest.approx(1.0, abs=1e-12)
    assert float(forgotten["energy_drift"]) == 0.0
