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
