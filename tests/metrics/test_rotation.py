"""A spinning square's metrics on motions with known answers."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.metrics import rotation
from sphstudy.model.exact.spinning_square import spinning_square
from sphstudy.model.scenes import spin

N, TURNS, RATE = 6, 3, 50.0


@pytest.fixture(scope="module")
def config():
    with session() as hydra:
        return hydra.points(["scene=spin", f"n={N}", f"scene.turns={TURNS}"], sweep=False)[0][0].config


def turned(x, y, angle, stretch):
    return stretch * (np.cos(angle) * x - np.sin(angle) * y), stretch * (
        np.sin(angle) * x + np.cos(angle) * y
    )


def record(config, rate, stretch):
    """The square turning with `rate`, stretched by stretch(time), with the momentum of turning so."""
    body = spin.square_body(config)
    time = np.linspace(0.0, TURNS * 2.0 * np.pi / RATE, 601)
    corner = turned(body.x[-1], body.y[-1], rate * time, stretch(time))
    end = turned(body.x, body.y, rate * time[-1], stretch(time[-1]))
    return xr.Dataset(
        {
            "history_time": ("sample", time),
            "history_u_x": ("sample", corner[0] - body.x[-1]),
            "history_u_y": ("sample", corner[1] - body.y[-1]),
            "history_angular_momentum": ("sample", 7.0 * stretch(time) ** 2),
            "reference_x": ("particle", body.x),
            "reference_y": ("particle", body.y),
            "x": (("snapshot", "particle"), end[0][None]),
            "y": (("snapshot", "particle"), end[1][None]),
            "spacing_x": body.spacing_x,
        }
    )


def values(run, config):
    return {name: metric.value for name, metric in rotation.measure(run, config).items()}


def test_rigid_rotation(config):
    found = values(record(config, RATE, np.ones_like), config)
    gain = spinning_square(1.0, RATE, spin.square_body(config).material).inertia_gain.value
    assert found["turns"] == pytest.approx(TURNS)
    assert found["rate"] == pytest.approx(RATE)
    assert found["rate_error"] == pytest.approx(gain, rel=0.02)
    assert found["angular_momentum_drift"] == 0.0
    assert found["corner_stretch_largest"] == pytest.approx(0.0, abs=1e-12)
    assert found["corner_stretch_mean_error"] == pytest.approx(-1.0)
    assert found["fourfold_defect"] < 1e-12


def test_breathing_shows_in_the_corner_and_in_the_momentum(config):
    found = values(record(config, -20.0, lambda t: 1.0 + 0.01 * np.sin(300.0 * t)), config)
    assert found["rate"] == pytest.approx(-20.0)
    assert found["corner_stretch_largest"] == pytest.approx(0.01, rel=1e-3)
    assert found["corner_stretch_smallest"] == pytest.approx(-0.01, rel=1e-3)
    assert found["angular_momentum_drift"] == pytest.approx(1.01**2 - 1.0, rel=1e-3)
    assert found["fourfold_defect"] < 1e-12


def test_a_corner_that_swings_about_the_steady_stretch_has_no_mean_error(config):
    steady = spinning_square(1.0, RATE, spin.square_body(config).material).corner_stretch.value
    run = record(
        config, RATE, lambda t: 1.0 + steady * (1.0 - np.cos(np.pi * t / t.max())) if t.ndim else 1.0
    )
    # Half a swing from where it starts, undeformed, to twice the steady stretch.
    assert values(run, config)["corner_stretch_mean_error"] == pytest.approx(0.0, abs=0.01)


def test_a_rectangle_or_a_particle_out_of_place_is_no_square(config):
    run = record(config, 0.0, np.ones_like)
    run["y"].values[0] *= 1.1
    # A corner (a, 1.1 a) and the image (1.1 a, a), a = 5/12, spacings of 1/6.
    assert values(run, config)["fourfold_defect"] == pytest.approx(0.1 * 2.5 * np.sqrt(2.0))
    run = record(config, 0.0, np.ones_like)
    run["x"].values[0, 8] += 0.05 / N
    assert values(run, config)["fourfold_defect"] == pytest.approx(0.05, rel=0.05)
    run = record(config, 0.0, np.ones_like)
    run["x"].values[0] += 0.3
    assert values(run, config)["fourfold_defect"] < 1e-12
