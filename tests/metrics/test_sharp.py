"""A step load's and a displaced particle's metrics on records with known answers."""

from functools import cache

import numpy as np
import pytest
import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.metrics import sharp
from sphstudy.model.exact.waves import longitudinal_speed, stopped_bar, stopped_chain
from sphstudy.model.scenes.sharp import build


@cache
def setting(scene):
    with session() as hydra:
        config = hydra.points([f"scene={scene}", "n=7"], sweep=False)[0][0].config
    return build(config), config


def wave(shift=0.0, stiffer=1.0):
    """The exact state, its front `shift` (m) too far, its stress times `stiffer`; the configuration."""
    problem, config = setting("sharp_wave")
    body, sound = problem.body, longitudinal_speed(problem.body.material)
    time = 0.6 / sound
    _, velocity, stress = stopped_bar(body.x, time + shift / sound, 0.01 * sound, body.material)
    fields = {
        "velocity_x": np.where(body.x <= 0.0, 0.0, velocity),
        "stress_xx": stiffer * stress,
    }
    data = {name: (("snapshot", "particle"), value[None]) for name, value in fields.items()}
    data |= {
        "snapshot_time": ("snapshot", [time]),
        "history_time": ("sample", [0.0, time]),
        "reference_x": ("particle", body.x),
        "tag_held": ("particle", body.tags["held"].astype(np.int8)),
        "spacing_x": body.spacing_x,
    }
    return xr.Dataset(data), config


def values(run, config):
    return {name: metric.value for name, metric in sharp.measure(run, config).items()}


def test_exact_front_has_no_error():
    found = values(*wave())
    assert found["velocity_error"] == 0.0
    assert found["stress_overshoot"] == pytest.approx(0.0, abs=1e-12)
    assert found["plateau_stress_error"] == pytest.approx(0.0, abs=1e-12)
    assert found["plateau_noise"] == 0.0
    # The jump is somewhere between two columns.
    assert abs(found["front_lag"]) <= 0.5


def test_a_late_front_is_late_and_a_stiff_one_presses_too_hard():
    found = values(*wave(shift=-5.0 / 70.0, stiffer=1.03))
    assert found["front_lag"] == pytest.approx(5.0 + values(*wave())["front_lag"])
    assert found["velocity_error"] == pytest.approx(5.0 / 69.0, rel=0.01)
    assert found["stress_overshoot"] == pytest.approx(0.03)
    assert found["plateau_stress_error"] == pytest.approx(0.03)


def test_noise_is_that_of_the_plateau_alone():
    run, config = wave()
    sound = longitudinal_speed(setting("sharp_wave")[0].body.material)
    x, column = run["reference_x"].values, np.tile(np.arange(70), 7)
    run["velocity_x"].values[0] += 0.01 * sound * np.where(column % 2 == 0, 0.1, -0.1)
    # Beside the front and beside the wall there may be more.
    wide = (x < 3.0 / 70.0) | (x > 0.5)
    run["velocity_x"].values[0] += 0.01 * sound * np.where(wide & (column % 2 == 0), 0.3, 0.0)
    assert values(run, config)["plateau_noise"] == pytest.approx(0.1)


def test_a_chain_is_as_noisy_as_a_chain():
    run, config = wave()
    body = setting("sharp_wave")[0].body
    sound = longitudinal_speed(body.material)
    chain = stopped_chain(body.sites[0], 0.6 * 70)
    run["velocity_x"].values[0] = 0.01 * sound * chain
    found = values(run, config)
    assert found["plateau_noise_ratio"] == pytest.approx(1.0)
    assert found["velocity_error"] < 0.06
    # The Airy front: half of the jump comes after the wave of infinite length.
    assert found["front_lag"] == pytest.approx(0.65, abs=0.1)


def test_a_bar_without_front_has_no_place_of_it():
    run, config = wave()
    run["velocity_x"].values[0] = 0.0
    assert np.isnan(values(run, config)["front_lag"])


def particle(left):
    """An oscillation of `left` times the offset in the last quarter, of all of it before."""
    config = setting("sharp_particle")[1]
    time = np.linspace(0.0, 1.0, 4001)
    size = np.where(time < 0.75, 1.0, left)
    data = {
        "history_time": ("sample", time),
        "history_u_x": ("sample", 0.03 * size * np.cos(2.0 * np.pi * 40.0 * time)),
        "history_u_y": ("sample", 0.03 * size * np.sin(2.0 * np.pi * 40.0 * time)),
        "history_hourglass_amplitude": (
            "sample",
            0.01 * size * np.abs(np.cos(2.0 * np.pi * 40.0 * time)),
        ),
    }
    return xr.Dataset(data), config


@pytest.mark.parametrize("left", [0.2, 1.0])
def test_what_is_left_is_that_of_the_last_quarter(left):
    found = values(*particle(left))
    assert found["offset_left"] == pytest.approx(left)
    assert found["hourglass_left"] == pytest.approx(left * np.sqrt(0.5), rel=1e-2)
    assert "velocity_error" not in found
