"""Plane waves against the wave equation, a stepped chain, and the acoustic tensor."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import airy

from sphstudy.model.exact.waves import (
    checkerboard_stiffness,
    longitudinal_speed,
    stopped_bar,
    stopped_chain,
)
from sphstudy.model.material import Material

STRAIN, STRESS = (Material(2.0e6, 0.3, 1500.0, plane) for plane in ("strain", "stress"))


def test_longitudinal_speed_by_poissons_ratio():
    """√(E(1-ν)/(ρ(1+ν)(1-2ν))) without lateral strain at all, √(E/(ρ(1-ν²))) in a sheet."""
    assert longitudinal_speed(STRAIN) == pytest.approx(np.sqrt(2e6 * 0.7 / (1500.0 * 1.3 * 0.4)))
    assert longitudinal_speed(STRESS) == pytest.approx(np.sqrt(2e6 / (1500.0 * 0.91)))


def test_stopped_bar_is_clamped_moves_with_its_velocity_and_obeys_hookes_law():
    x = np.array([0.0, 0.1, 0.2, 0.6, 0.9])
    time, step = 0.4 / longitudinal_speed(STRAIN), 1e-9
    before, after = (stopped_bar(x, time + s, 0.3, STRAIN)[0] for s in (-step, step))
    displacement, velocity, stress = stopped_bar(x, time, 0.3, STRAIN)
    assert displacement[0] == 0.0
    np.testing.assert_allclose((after - before) / (2.0 * step), velocity, atol=1e-6)
    beside = stopped_bar(x + 1e-6, time, 0.3, STRAIN)[0]
    modulus = STRAIN.lame_modulus + 2.0 * STRAIN.shear_modulus
    np.testing.assert_allclose(modulus * (beside - displacement) / 1e-6, stress, rtol=1e-6)
    assert (stress < 0.0).tolist() == [True, True, True, False, False]


def test_impulse_of_the_wall_is_the_momentum_lost():
    x = np.linspace(0.0, 1.0, 100_001)
    time = 0.37 / longitudinal_speed(STRESS)
    _, velocity, stress = stopped_bar(x, time, 0.3, STRESS)
    lost = STRESS.density * np.trapezoid(velocity + 0.3, x)
    assert -stress[0] * time == pytest.approx(lost, rel=1e-4)


def test_stopped_chain_is_what_stepping_it_gives():
    count, phase = 60, 20.0

    def rates(_, state):
        u, v = state.reshape(2, count)
        pull = np.zeros(count)
        pull[1:-1] = u[2:] - 2.0 * u[1:-1] + u[:-2]
        return np.concatenate((np.where(np.arange(count) > 0, v, 0.0), pull))

    start = np.concatenate((np.zeros(count), -(np.arange(count) > 0).astype(float)))
    stepped = solve_ivp(rates, (0.0, phase), start, rtol=1e-9, atol=1e-11).y[count:, -1]
    # Its own free end is 40 masses behind the front.
    np.testing.assert_allclose(stopped_chain(np.arange(40), phase), stepped[:40], atol=1e-7)


def test_stopped_chain_overshoots_as_the_integral_of_airys_function():
    overshoot = quad(lambda z: airy(z)[0], -2.3381, 0.0)[0] + 1.0 / 3.0 - 1.0
    assert overshoot == pytest.approx(0.274, abs=5e-4)
    found = stopped_chain(np.arange(20_500), 20_000.0).max()
    assert found == pytest.approx(overshoot, abs=0.002)


@pytest.mark.parametrize("material", [STRAIN, STRESS])
def test_checkerboard_stiffness_is_the_energy_of_the_wave(material):
    """Elastic energy of u_x = sin(k·x), averaged over a period: a quarter of the stiffness over Δ²."""
    at = (np.arange(64) + 0.5) / 32.0
    x, y = np.meshgrid(at, at)
    wave = np.pi * np.cos(np.pi * (x + y))
    lame, shear = material.lame_modulus, material.shear_modulus
    density = (0.5 * lame + shear) * wave**2 + 0.5 * shear * wave**2
    assert checkerboard_stiffness(material) == pytest.approx(4.0 * density.mean())
