"""Constitutive laws: stress and tangent as derivatives, Hooke's law as limit, the solid's law in 3-D."""

import itertools

import numpy as np
import pytest
from scipy.optimize import brentq

from sphstudy.model.material import Material
from sphstudy.numerics.sph.constitutive import (
    LAWS,
    energy_densities,
    energy_density,
    law,
    stress,
    stresses,
    tangent,
)

YOUNGS_MODULUS, POISSON_RATIO = 2.0, 0.3
PLANES = ("strain", "stress")
OBJECTIVE = ("svk", "neohookean")
UNDEFORMED = np.array([[1.0], [0.0], [0.0], [1.0]])

every_law = pytest.mark.parametrize(("name", "plane"), [*itertools.product(LAWS, PLANES)])
every_objective_law = pytest.mark.parametrize(("name", "plane"), [*itertools.product(OBJECTIVE, PLANES)])


def named(name, plane):
    return law(name, Material(YOUNGS_MODULUS, POISSON_RATIO, 1.0, plane))


def derivative(function, step):
    """d function(s)/ds at s = 0: central differences, extrapolated to an error of fourth order."""

    def central(s):
        return (function(s) - function(-s)) / (2.0 * s)

    return (4.0 * central(0.5 * step) - central(step)) / 3.0


def by_component(function, gradient):
    """The derivative of function(F) by the components of F, [..., 4, N]."""
    directions = np.eye(4)[:, :, None]
    return np.stack(
        [derivative(lambda s, d=d: function(gradient + s * d), 1e-3) for d in directions], axis=-2
    )


def rotation(angle):
    """R [2, 2]."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def rotated(angle, tensor):
    """R T of the tensors [4, N]."""
    return np.einsum("ab,bcn->acn", rotation(angle), tensor.reshape(2, 2, -1)).reshape(4, -1)


def hooke(plane):
    """∂σ_ab/∂F_cd [2, 2, 2, 2] of Hooke's law, from the textbooks' matrices in E and ν."""
    e, nu = YOUNGS_MODULUS, POISSON_RATIO
    direct, cross = e / (1.0 - nu**2), e * nu / (1.0 - nu**2)
    if plane == "strain":
        scale = e / ((1.0 + nu) * (1.0 - 2.0 * nu))
        direct, cross = scale * (1.0 - nu), scale * nu
    moduli = np.zeros((2, 2, 2, 2))
    moduli[0, 0, 0, 0] = moduli[1, 1, 1, 1] = direct
    moduli[0, 0, 1, 1] = moduli[1, 1, 0, 0] = cross
    for a, b in ((0, 1), (1, 0)):
        moduli[a, b, a, b] = moduli[a, b, b, a] = 0.5 * e / (1.0 + nu)
    return moduli


def solid_energy(name, gradient):
    """ψ of the solid at F [3, 3], real or complex, from the definitions in three dimensions."""
    e, nu = YOUNGS_MODULUS, POISSON_RATIO
    lame, shear = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu))
    right = gradient.T @ gradient
    if name == "neohookean":
        log_volume = np.log(np.linalg.det(gradient))
        return 0.5 * shear * (np.trace(right) - 3.0) - shear * log_volume + 0.5 * lame * log_volume**2
    stretch = right if name == "svk" else gradient + gradient.T
    strain = 0.5 * (stretch - (1.0 if name == "svk" else 2.0) * np.eye(3))
    return 0.5 * lame * np.trace(strain) ** 2 + shear * np.sum(strain * strain)


def solid_slope(name, gradient, a, b):
    """∂ψ/∂F_ab of the solid, by a complex step: exact to rounding."""
    stepped = gradient.astype(complex)
    stepped[a, b] += 1e-30j
    return solid_energy(name, stepped).imag / 1e-30


def in_the_solid(name, plane, gradient):
    """The plane F [4] as F [3, 3]: thickness kept, or such that no stress acts through it."""
    solid = np.eye(3)
    solid[:2, :2] = gradient.reshape(2, 2)
    if plane == "strain":
        return solid

    def through(thickness):
        solid[2, 2] = thickness
        return solid_slope(name, solid, 2, 2)

    solid[2, 2] = brentq(through, 0.3, 3.0, xtol=1e-15)
    return solid


@pytest.fixture
def gradients(rng):
    """Deformation gradients [4, N] with strains of order 0.3, some of them rotated far."""
    found = np.concatenate([UNDEFORMED + rng.uniform(-0.3, 0.3, (4, 6)) for _ in range(3)], axis=1)
    found[:, 6:12] = rotated(1.3, found[:, 6:12])
    found[:, 12:] = rotated(-2.5, found[:, 12:])
    assert np.linalg.det(found.T.reshape(-1, 2, 2)).min() > 0.3
    return found


@every_law
def test_stress_is_the_derivative_of_the_energy(name, plane, gradients):
    used = named(name, plane)
    expected = by_component(lambda f: energy_densities(used, f), gradients)
    np.testing.assert_allclose(stresses(used, gradients), expected, rtol=0.0, atol=1e-8)


@every_law
def test_tangent_is_the_derivative_of_the_stress(name, plane, gradients):
    used = named(name, plane)
    expected = by_component(lambda f: stresses(used, f), gradients)
    computed = tangent(used, gradients).reshape(4, 4, -1)
    np.testing.assert_allclose(computed, expected, rtol=0.0, atol=1e-7)


@every_law
def test_tangent_has_major_symmetry(name, plane, gradients):
    computed = tangent(named(name, plane), gradients)
    np.testing.assert_allclose(computed, np.moveaxis(computed, (0, 1), (2, 3)), rtol=0.0, atol=1e-13)


@every_law
def test_the_undeformed_state_is_free_of_energy_and_stress_and_has_hookes_tangent(name, plane):
    used = named(name, plane)
    assert np.abs(energy_densities(used, UNDEFORMED)).max() < 1e-16
    assert np.abs(stresses(used, UNDEFORMED)).max() < 1e-16
    np.testing.assert_allclose(tangent(used, UNDEFORMED)[..., 0], hooke(plane), rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("plane", PLANES)
def test_the_linear_law_is_hookes_law_at_any_strain(plane, gradients):
    expected = np.einsum("abcd,cdn->abn", hooke(plane), (gradients - UNDEFORMED).reshape(2, 2, -1))
    computed = stresses(named("linear", plane), gradients).reshape(2, 2, -1)
    np.testing.assert_allclose(computed, expected, rtol=0.0, atol=1e-14)


@every_objective_law
def test_departure_from_hookes_law_is_of_first_order_in_the_strain(name, plane, rng):
    used, direction = named(name, plane), rng.normal(size=(4, 1))
    expected = np.einsum("abcd,cd->ab", hooke(plane), direction.reshape(2, 2)).reshape(4, 1)
    gaps = [
        np.abs(stresses(used, UNDEFORMED + size * direction) / size - expected).max()
        for size in (2e-3, 1e-3)
    ]
    assert np.log2(gaps[0] / gaps[1]) == pytest.approx(1.0, abs=0.02)


@every_objective_law
@pytest.mark.parametrize("angle", [0.1, 1.3, 3.0])
def test_rotation_turns_the_stress_of_an_objective_law_and_keeps_its_energy(
    name, plane, angle, gradients
):
    used = named(name, plane)
    assert used.objective
    turned = rotated(angle, gradients)
    np.testing.assert_allclose(
        energy_densities(used, turned), energy_densities(used, gradients), rtol=0.0, atol=1e-14
    )
    np.testing.assert_allclose(
        stresses(used, turned), rotated(angle, stresses(used, gradients)), rtol=0.0, atol=1e-14
    )


@pytest.mark.parametrize("plane", PLANES)
def test_the_linear_law_takes_a_rotation_for_a_strain(plane):
    used = named("linear", plane)
    assert not used.objective
    turned = rotated(1.3, UNDEFORMED)
    assert energy_densities(used, turned)[0] > 0.1 * YOUNGS_MODULUS
    assert np.abs(stresses(used, turned)).max() > 0.1 * YOUNGS_MODULUS


@every_law
def test_plane_laws_are_the_solids_own(name, plane, gradients):
    """Plane stress: the stretch through the thickness by root finding, in three dimensions.

    At that root the energy is stationary, so the solid's stress in the plane is the derivative sought.
    """
    used = named(name, plane)
    for gradient in gradients.T if name != "linear" else gradients[:, :6].T:
        solid = in_the_solid(name, plane, gradient)
        if plane == "stress":
            assert abs(solid_slope(name, solid, 2, 2)) < 1e-13
        energy, computed = energy_density(used, *gradient), stress(used, *gradient)
        assert energy == pytest.approx(solid_energy(name, solid), abs=1e-13)
        expected = [solid_slope(name, solid, a, b) for a in range(2) for b in range(2)]
        np.testing.assert_allclose(computed, expected, rtol=0.0, atol=1e-13)


@every_law
def test_arrays_hold_what_the_scalar_functions_give(name, plane, gradients):
    used = named(name, plane)
    expected = np.transpose([stress(used, *gradient) for gradient in gradients.T])
    np.testing.assert_allclose(stresses(used, gradients), expected, rtol=0.0, atol=1e-14)
    expected = [energy_density(used, *gradient) for gradient in gradients.T]
    np.testing.assert_allclose(energy_densities(used, gradients), expected, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("plane", PLANES)
def test_the_neo_hookean_law_knows_nothing_of_matter_turned_inside_out(plane):
    """Nothing is a number where det F < 0, nothing finite where it is zero."""
    used = named("neohookean", plane)
    inside_out = np.array([[1.0, -1.0, 0.2], [0.0, 0.1, 1.0], [0.0, 0.2, 1.0], [-1.0, 1.0, 0.3]])
    flat = np.array([[1.0], [0.5], [0.5], [0.25]])
    with np.errstate(all="ignore"):
        assert np.isnan(stresses(used, inside_out)).all()
        assert np.isnan(energy_densities(used, inside_out)).all()
        assert not np.isfinite(stresses(used, flat)).any()
        assert not np.isfinite(energy_densities(used, flat)).any()
