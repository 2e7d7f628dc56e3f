"""Period and amplitudes on synthetic swings."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.metrics import swings as module
from sphstudy.metrics.swings import loss_per_period, period, swings

TIME = np.linspace(0.0, 30.2, 3001)
"""Thirty periods of 1 s, a hundred samples each."""


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("decay", [0.0, 0.05, -0.02])
def test_period_and_loss_of_a_damped_sine(sign, decay):
    found = swings(TIME, sign * 0.02 * np.exp(-decay * TIME) * np.sin(2 * np.pi * TIME))
    assert found.crossings.size == 61
    assert found.crossings[0] == 0.0
    assert period(found) == pytest.approx(1.0, rel=1e-6)
    assert loss_per_period(found.peaks) == pytest.approx(1.0 - np.exp(-decay), abs=1e-6)
    # The peak comes before a quarter of a period, by decay/(2π)²: of second order in the amplitude.
    assert found.peaks[0] == pytest.approx(0.02 * np.exp(-0.25 * decay), rel=5e-5)


def test_a_start_away_from_rest_is_no_crossing():
    found = swings(TIME, np.cos(2 * np.pi * TIME))
    np.testing.assert_allclose(found.crossings[:3], [0.25, 0.75, 1.25], atol=1e-6)
    assert period(found) == pytest.approx(1.0, rel=1e-6)


def test_a_swing_that_is_no_sine_has_its_period_and_its_peak():
    """A third harmonic moves neither; a fit of a sine would take it for an amplitude of 1."""
    found = swings(TIME, np.sin(2 * np.pi * TIME) - 0.2 * np.sin(6 * np.pi * TIME))
    assert period(found) == pytest.approx(1.0, rel=1e-5)
    np.testing.assert_allclose(found.peaks, 1.2, rtol=1e-4)


def test_peaks_are_found_between_few_samples():
    time = np.linspace(0.0, 3.02, 61)
    np.testing.assert_allclose(swings(time, np.sin(2 * np.pi * time)).peaks, 1.0, atol=1e-3)


def test_a_doubled_sample_changes_nothing():
    twice = np.sort(np.append(TIME, TIME[[25, 733]]))
    plain, doubled = (swings(t, np.sin(2 * np.pi * t)) for t in (TIME, twice))
    np.testing.assert_array_equal(plain.crossings, doubled.crossings)
    np.testing.assert_array_equal(plain.peaks, doubled.peaks)


def test_losses_are_weighed_from_the_first_swings_to_the_last():
    assert loss_per_period(np.array([1.0, 0.9, 0.81])) == pytest.approx(0.19)
    # Two periods of 1, then two of a half, the middles ten periods apart; what lies between is not asked.
    peaks = np.concatenate((np.ones(4), np.full(16, 7.0), np.full(4, 0.5)))
    assert loss_per_period(peaks) == pytest.approx(1.0 - 0.5**0.1)


def record(time, displacement):
    return xr.Dataset({"history_time": ("sample", time), "history_u_y": ("sample", displacement)})


def test_a_tip_that_hardly_moves_has_neither_and_says_why():
    found = module.measure(record(TIME[:20], TIME[:20]), None)
    assert np.isnan(found["period"].value)
    assert np.isnan(found["amplitude_loss_per_period"].value)
    assert "swings less than once" in found["period"].remark
    assert module.measure(xr.Dataset(), None) == {}


def test_a_record_that_swings_has_all_four_without_remark():
    found = module.measure(record(TIME, np.exp(-0.05 * TIME) * np.sin(2 * np.pi * TIME)), None)
    assert found["period"].value == pytest.approx(1.0, rel=1e-6)
    assert found["amplitude_first"].value > found["amplitude_last"].value > 0.2
    assert not any(metric.remark for metric in found.values())
