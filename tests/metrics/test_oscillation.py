"""The fit of the damped sine on synthetic data."""

import numpy as np
import pytest

from sphstudy.metrics.oscillation import fit_damped_sine

TIME = np.linspace(0.0, 6.54, 401)


@pytest.mark.parametrize("ratio", [0.8, 0.9, 1.0, 1.1])
@pytest.mark.parametrize("decay", [0.0, 0.05, 0.2])
def test_recovers_amplitude_decay_and_frequency(ratio, decay):
    omega = 0.96 * ratio
    fit = fit_damped_sine(TIME, 0.02 * np.exp(-decay * TIME) * np.sin(omega * TIME), 0.96)
    assert fit.amplitude == pytest.approx(0.02, rel=1e-6)
    assert fit.omega == pytest.approx(omega, rel=1e-6)
    assert fit.decay == pytest.approx(decay, abs=1e-7)
    assert fit.residual < 1e-6


def test_intervals_cover_the_truth_about_as_often_as_they_say(rng):
    truth = 0.02 * np.exp(-0.03 * TIME) * np.sin(0.95 * TIME)
    covered = 0
    for _ in range(200):
        fit = fit_damped_sine(TIME, truth + rng.normal(scale=1e-3, size=TIME.size), 0.96)
        covered += abs(fit.omega - 0.95) < fit.omega_interval
    # 95 % of 200 is 190; four standard deviations of that count are 12.
    assert 178 <= covered <= 200


def test_residual_is_the_noise_over_the_amplitude(rng):
    noisy = 0.02 * np.sin(0.95 * TIME) + rng.normal(scale=1e-3, size=TIME.size)
    assert fit_damped_sine(TIME, noisy, 0.96).residual == pytest.approx(0.05, rel=0.15)


@pytest.mark.parametrize(
    ("time", "displacement", "complaint"),
    [
        (TIME[:3], TIME[:3], "at least 5"),
        (TIME, np.full(TIME.size, np.nan), "not finite"),
        (TIME, np.zeros(TIME.size), "nothing moves"),
    ],
)
def test_refuses_what_cannot_be_fitted(time, displacement, complaint):
    with pytest.raises(ValueError, match=complaint):
        fit_damped_sine(time, displacement, 0.96)


@pytest.mark.parametrize("ratio", [0.4, 0.5, 0.8, 1.1, 2.0])
@pytest.mark.parametrize("decay", [-0.05, 0.0, 0.3])
@pytest.mark.parametrize("periods", [1, 20])
def test_finds_a_frequency_far_from_the_guess_in_long_and_growing_records(ratio, decay, periods):
    time, omega = np.linspace(0.0, periods * 6.54, 401), 0.96 * ratio
    fit = fit_damped_sine(time, 0.02 * np.exp(-decay * time) * np.sin(omega * time), 0.96)
    assert fit.omega == pytest.approx(omega, rel=1e-6)
    assert fit.amplitude == pytest.approx(0.02, rel=1e-6)
    assert fit.decay == pytest.approx(decay, abs=1e-6)


def test_intervals_cover_with_few_samples_too(rng):
    time = np.linspace(0.0, 6.54, 8)
    truth = 0.02 * np.exp(-0.03 * time) * np.sin(0.95 * time)
    covered = 0
    for _ in range(600):
        fit = fit_damped_sine(time, truth + rng.normal(scale=5e-4, size=8), 0.96)
        covered += abs(fit.omega - 0.95) < fit.omega_interval
    # 95 % of 600 is 570, standard deviation 5.3; the normal quantile 1.96 would cover 89 %, 536.
    assert 549 <= covered <= 591
