"""Homogeneous states against least energy, the stresses of the laws, and the rate law integrated."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from sphstudy.model.exact import homogeneous
from sphstudy.model.material import Material
from sphstudy.numerics.sph import constitutive

MATERIAL = Material(1e6, 0.3, 7750.0, "strain")
LAWS = constitutive.LAWS
STRAINS = (-0.1, 0.01, 0.05, 0.2, 0.5)


def energy(law, along, across):
    gradient = np.array([[along], [0.0], [0.0], [across]])
    return constitutive.energy_densities(constitutive.law(law, MATERIAL), gradient)[0]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("strain", STRAINS)
def test_a_bar_takes_the_width_of_least_energy(law, strain):
    found = homogeneous.lateral_stretch(law, MATERIAL, strain)
    least = minimize_scalar(
        lambda across: energy(law, 1.0 + strain, across), bounds=(0.4, 1.3), options={"xatol": 1e-9}
    )
    # Where a function is flat its minimum is known to half of the digits.
    assert found == pytest.approx(least.x, abs=1e-6)
    assert (found - 1.0) * strain < 0.0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("strain", STRAINS)
def test_stresses_are_those_of_the_law(law, strain):
    along, across = 1.0 + strain, homogeneous.lateral_stretch(law, MATERIAL, strain)
    gradient = np.array([[along, along], [0.0, 0.0], [0.0, 0.0], [across, along]])
    first = constitutive.stresses(constitutive.law(law, MATERIAL), gradient)
    # Cauchy's stress; the linear law knows no difference.
    factor = 1.0 / np.array([across, along]) if law != "linear" else np.ones(2)
    uniaxial, equibiaxial = first[0] * factor
    assert first[3, 0] == pytest.approx(0.0, abs=1e-9 * MATERIAL.youngs_modulus)
    assert homogeneous.uniaxial_stress(law, MATERIAL, strain) == pytest.approx(uniaxial, rel=1e-12)
    assert homogeneous.equibiaxial_stress(law, MATERIAL, strain) == pytest.approx(equibiaxial, rel=1e-12)


@pytest.mark.parametrize("strain", STRAINS)
def test_rate_law_is_its_own_integral(strain):
    """Ends move at constant speed; across a bar the rate of σ_yy vanishes, a disc moves there alike."""
    lame, shear = MATERIAL.lame_modulus, MATERIAL.shear_modulus

    def rates(time, state):
        along = strain / (1.0 + strain * time)
        across = -lame * along / (lame + 2.0 * shear)
        uniaxial = lame * (along + across) + 2.0 * shear * along
        return uniaxial, across * state[1], 2.0 * (lame + shear) * along

    end = solve_ivp(rates, (0.0, 1.0), (0.0, 1.0, 0.0), rtol=1e-10, atol=1e-10).y[:, -1]
    found = (
        homogeneous.uniaxial_stress("rate", MATERIAL, strain),
        homogeneous.lateral_stretch("rate", MATERIAL, strain),
        homogeneous.equibiaxial_stress("rate", MATERIAL, strain),
    )
    assert found == pytest.approx(tuple(end), rel=1e-8)


def test_all_laws_are_hookes_at_small_strain():
    for law in (*LAWS, "rate"):
        bar = homogeneous.uniaxial_stress(law, MATERIAL, 1e-7)
        disc = homogeneous.equibiaxial_stress(law, MATERIAL, 1e-7)
        assert bar == pytest.approx(1e6 / (1.0 - 0.3**2) * 1e-7, rel=1e-6)
        assert disc == pytest.approx(1e6 / (1.3 * 0.4) * 1e-7, rel=1e-6)


@pytest.mark.parametrize("answer", ["lateral_stretch", "uniaxial_stress", "equibiaxial_stress"])
def test_an_unknown_law_is_refused(answer):
    with pytest.raises(ValueError, match="must be linear, svk, neohookean or rate"):
        getattr(homogeneous, answer)("ogden", MATERIAL, 0.1)
