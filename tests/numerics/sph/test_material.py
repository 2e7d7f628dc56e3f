"""Hooke's law: moduli, plane stress by the thesis's primed constants, compliance as inverse."""

import numpy as np
import pytest

from sphstudy.model.material import Material


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_plane_stress_is_the_thesis_formula_with_primed_constants(nu):
    e = 6e6
    material = Material(e, nu, 1.0, "stress")
    primed_e, primed_nu = material.primed
    assert primed_e == pytest.approx(e * (1 + 2 * nu) / (1 + nu) ** 2, rel=1e-14)
    lame = primed_e * primed_nu / ((1 + primed_nu) * (1 - 2 * primed_nu))
    assert material.lame_modulus == pytest.approx(lame, rel=1e-14)
    assert material.shear_modulus == pytest.approx(primed_e / (2 * (1 + primed_nu)), rel=1e-14)


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_compliance_inverts_the_stress_strain_law(plane, rng):
    material = Material(2e6, 0.3, 1.0, plane)
    exx, eyy, exy = rng.normal(size=3)
    lame, mu = material.lame_modulus, material.shear_modulus
    sxx = lame * (exx + eyy) + 2 * mu * exx
    syy = lame * (exx + eyy) + 2 * mu * eyy
    e, nu = material.compliance
    assert (sxx - nu * syy) / e == pytest.approx(exx, rel=1e-12)
    assert (1 + nu) * (2 * mu * exy) / e == pytest.approx(exy, rel=1e-12)


def test_wave_speed_of_the_thesis_plate():
    """N = 4840 = ⌈(1/6 s)/Δt⌉ at n = 21, C = 0.09 pins c0 = √(K/ρ) from the unprimed constants."""
    material = Material(1e6, 0.3, 7750.0, "strain")
    dt = 0.09 * (1.0 / 12.0 / 21.0) / material.wave_speed
    assert np.ceil((1.0 / 6.0) / dt) == 4840


def test_wave_speed_of_the_thesis_crack():
    """N = 8467 = ⌈0.1 s/Δt⌉ at n = 60, C = 0.09, in plane stress too."""
    material = Material(6e6, 0.3, 7750.0, "stress")
    dt = 0.09 * (0.2 / 60.0) / material.wave_speed
    assert np.ceil(0.1 / dt) == 8467
