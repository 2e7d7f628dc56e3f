"""The builder of Gray's plate: what is held, where particles stand, how it starts."""

import numpy as np
import pytest

from sphstudy.catalogue import scene_module
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.model.scenes import gray_plate


def configured(*overrides):
    with session() as hydra:
        return hydra.points(["scene=gray_plate", "method=tl", *overrides], sweep=False)[0][0].config


def built(*overrides):
    config = configured(*overrides)
    return config, gray_plate.build(config)


@pytest.mark.parametrize("n", [5, 6])
@pytest.mark.parametrize("clamp", ["rigid", "insert"])
def test_the_cells_of_the_particles_fill_the_plate(n, clamp):
    config, problem = built(f"n={n}", f"scene.clamp={clamp}")
    body, half = problem.body, 0.5 * problem.body.spacing_x
    assert body.x.size == gray_plate.particles(config) == config.n * (10 * n + n * (clamp == "insert"))
    assert body.x.max() + half == pytest.approx(0.2, rel=1e-12)
    assert body.y.max() + 0.5 * body.spacing_y == pytest.approx(0.01, rel=1e-12)
    assert body.y.sum() == pytest.approx(0.0, abs=1e-12)
    assert (np.abs(body.y).min() == 0.0) == (n % 2 == 1)
    left = body.x.min() - half
    assert left == pytest.approx(
        -half if clamp == "rigid" else -config.scene.held_length(config.n), rel=1e-12
    )


def test_a_rigid_clamp_holds_the_column_at_the_wall():
    _, problem = built("n=6")
    held = problem.constraints.x_index
    np.testing.assert_array_equal(held, np.flatnonzero(problem.body.x == 0.0))
    np.testing.assert_array_equal(held, problem.constraints.y_index)
    assert held.size == 6


def test_an_insert_is_held_at_its_faces_and_nowhere_else():
    config, problem = built("n=6", "scene.clamp=insert", "scene.insert_length=1.5")
    body = problem.body
    assert config.scene.held_length(config.n) == pytest.approx(1.5 * 0.02)
    assert body.spacing_x == body.spacing_y
    inside = (body.x < 0.0) & (np.abs(body.y) > 0.01 - body.spacing_y)
    assert inside.sum() == 2 * 9
    np.testing.assert_array_equal(problem.constraints.x_index, np.flatnonzero(inside))
    np.testing.assert_array_equal(problem.constraints.y_index, np.flatnonzero(inside))
    assert not problem.velocity_y[body.x < 0.0].any()


@pytest.mark.parametrize("speed", [0.01, 0.05])
def test_the_tip_starts_at_its_share_of_the_wave_speed(speed):
    """c0 = 57.03 m/s from E, ν and ρ; the mode grows by 1.3765/L per length at the free end."""
    _, problem = built("n=10", f"scene.tip_speed={speed}")
    assert not problem.velocity_x.any()
    end = problem.body.x[problem.tracked]
    expected = speed * 57.0301 * (1.0 - 1.3765 * (0.2 - end) / 0.2)
    assert problem.velocity_y[problem.tracked] == pytest.approx(expected, rel=1e-4)
    assert np.abs(problem.velocity_y).max() == problem.velocity_y[problem.tracked]


@pytest.mark.parametrize("n", [5, 6])
def test_the_particle_that_is_watched_ends_the_mid_line(n):
    _, problem = built(f"n={n}")
    body = problem.body
    assert body.x[problem.tracked] == body.x.max()
    assert abs(body.y[problem.tracked]) == np.abs(body.y).min()


def test_it_runs_for_two_periods_of_the_thin_plate():
    """0.2540 s, as Gray, Monaghan and Swift have it."""
    _, problem = built()
    assert problem.stages[0].duration == pytest.approx(2 * 0.2540, rel=2e-4)


def test_too_few_rows_are_refused():
    with pytest.raises(ConfigurationError, match="n=2: must be at least 3 in gray_plate"):
        configured("n=2", "h=0.8")


@pytest.mark.parametrize("scene", ["long_plate", "large_plate", "incompressible"])
def test_plates_that_swing_far_or_for_long_are_the_plate(scene):
    """The same body and the same push per length of swing; rows stay odd."""
    with session() as hydra:
        base, other = (
            hydra.points([f"scene={name}", "n=5", "scene.nu=0.3"], sweep=False)[0][0].config
            for name in ("plate", scene)
        )
        with pytest.raises(ConfigurationError, match=f"n=6: must be odd in {scene}"):
            hydra.points([f"scene={scene}", "n=6"], sweep=False)
    plate, swinging = (scene_module(c.scene.kind).build(c) for c in (base, other))
    np.testing.assert_array_equal(plate.body.x, swinging.body.x)
    np.testing.assert_array_equal(plate.constraints.x_index, swinging.constraints.x_index)
    ratio = other.scene.H0 / base.scene.H0
    np.testing.assert_allclose(swinging.velocity_y, ratio * plate.velocity_y, rtol=1e-14)
    periods = other.scene.periods / base.scene.periods
    assert swinging.stages[0].duration == pytest.approx(periods * plate.stages[0].duration)
