"""Errors of periods, on histories with a known one."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.metrics import period


def measured(overrides, true_period, amplitude=1.0, tip=0.199):
    with session() as hydra:
        config = hydra.points(["method=tl", *overrides], sweep=False)[0][0].config
    time = np.linspace(0.0, 2.1 * true_period, 801)
    run = xr.Dataset(
        {
            "history_time": ("sample", time),
            "history_u_y": ("sample", amplitude * np.sin(2 * np.pi * time / true_period)),
            "reference_x": ("particle", np.array([0.0, tip])),
        }
    )
    return {name: metric.value for name, metric in period.measure(run, config).items()}


def test_gray_plate_against_both_of_its_references():
    found = measured(["scene=gray_plate", "n=20"], 0.2600)
    assert found["period_2d"] == pytest.approx(0.2552, abs=5e-5)
    assert found["period_thin_plate"] == pytest.approx(0.2540, abs=5e-5)
    assert found["period_error_2d"] == pytest.approx(0.26 / found["period_2d"] - 1.0, abs=1e-6)
    assert found["period_error_thin_plate"] == pytest.approx(0.26 / 0.2540 - 1.0, abs=2e-4)
    assert found["period_error_scaled"] == pytest.approx(4.0 * found["period_error_2d"])


def test_gray_plate_of_too_short_a_period_has_an_error_of_the_other_sign_and_a_positive_scaled_one():
    found = measured(["scene=gray_plate", "n=10"], 0.2500)
    assert found["period_error_2d"] < -0.02
    assert found["period_error_scaled"] == -found["period_error_2d"]


def test_gray_plate_amplitude_is_that_of_the_tip_speed_at_the_tracked_particle():
    """0.01 · 57.03 m/s, less 1.3765 · 0.005 for a particle half a cell before the end, over ω."""
    found = measured(["scene=gray_plate", "n=10"], 0.2552)
    expected = 0.570301 * (1.0 - 1.3765 * 0.005) * 0.25523 / (2.0 * np.pi)
    assert found["amplitude_error"] == pytest.approx(1.0 / expected - 1.0, rel=1e-3)


def test_other_plates_have_their_own_reference_and_no_tip_speed():
    found = measured(["scene=long_plate", "n=5"], 6.3)
    assert found["period_2d"] == pytest.approx(2 * np.pi / 1.003081, rel=1e-5)
    assert "amplitude_error" not in found


def test_modes_have_no_swings():
    assert period.measure(xr.Dataset(), None) == {}
