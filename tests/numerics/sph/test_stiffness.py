"""The sparse tangent against forces and energies, and its eigenvalues: what costs little or nothing."""

import numpy as np
import pytest
from scipy.linalg import eigh

from sphstudy.model.material import Material
from sphstudy.numerics.sph import constitutive, stiffness
from tests.numerics.sph.test_bonds import every_kernel
from tests.numerics.sph.test_constitutive import UNDEFORMED, derivative
from tests.numerics.sph.test_total_lagrangian import (
    NEO_HOOKEAN,
    SVK,
    cracked,
    deformed,
    energies,
    every_law,
    force,
    gradient,
    reference,
    square,
)

every_body = pytest.mark.parametrize("body", ["cloud", "mixed"])
every_zeta = pytest.mark.parametrize("zeta", [1.0, 0.3, pytest.param(0.0, marks=pytest.mark.interpreted)])


def tangent(made, positions):
    """K at these positions."""
    return stiffness.tangent(made, stiffness.operators(made), gradient(made, positions))


def undeformed(made):
    """K of the reference configuration [2N, 2N], dense."""
    everywhere = np.tile(UNDEFORMED, made.x.size)
    return stiffness.tangent(made, stiffness.operators(made), everywhere).toarray()


def largest(matrix):
    return np.abs(matrix).max()


@every_body
@every_zeta
def test_under_the_linear_law_it_holds_at_any_displacement(rng, body, zeta):
    made = cracked(body, rng, name="linear", plane="stress", hourglass=zeta)
    start, end = reference(made), deformed(made, rng)
    change = force(made, end) - force(made, start)
    displacement = (end - start).ravel()
    pulled = tangent(made, start) @ displacement
    np.testing.assert_allclose(pulled, -change.ravel(), rtol=0.0, atol=1e-10 * largest(change))
    assert 0.5 * displacement @ pulled == pytest.approx(energies(made, end).sum(), rel=1e-12)


@every_kernel
def test_under_the_linear_law_it_holds_with_every_kernel(rng, shape):
    made = cracked("cloud", rng, name="linear", plane="stress", shape=shape)
    end = deformed(made, rng)
    pulled = tangent(made, end) @ (end - reference(made)).ravel()
    change = force(made, end)
    np.testing.assert_allclose(pulled, -change.ravel(), rtol=0.0, atol=1e-10 * largest(change))


@pytest.mark.parametrize(("name", "plane"), [SVK, *NEO_HOOKEAN])
@every_body
def test_it_is_the_derivative_of_the_force_at_a_deformed_state(rng, body, name, plane):
    made = cracked(body, rng, name=name, plane=plane)
    positions = deformed(made, rng)
    matrix = tangent(made, positions)
    for _ in range(3):
        direction = rng.uniform(-1.0, 1.0, positions.shape)
        slope = derivative(lambda s, d=direction: force(made, positions + s * d), 1e-3)
        pulled = matrix @ direction.ravel()
        np.testing.assert_allclose(pulled, -slope.ravel(), rtol=0.0, atol=1e-6 * largest(slope))


@every_law
@every_body
def test_it_is_symmetric(rng, body, name, plane):
    made = cracked(body, rng, name=name, plane=plane)
    matrix = tangent(made, deformed(made, rng)).toarray()
    np.testing.assert_allclose(matrix, matrix.T, rtol=0.0, atol=1e-13 * largest(matrix))


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_all_laws_share_the_tangent_of_the_reference_configuration(rng, plane):
    made = cracked("cloud", rng, name="linear", plane=plane)
    expected = undeformed(made)
    for name in ("svk", "neohookean"):
        law = constitutive.law(name, Material(2.0, 0.3, 1.0, plane))
        matrix = undeformed(made._replace(law=law))
        np.testing.assert_allclose(matrix, expected, rtol=0.0, atol=1e-13 * largest(expected))


@pytest.mark.parametrize("smoothing_length", [1.3, 1.5])
@pytest.mark.parametrize("zeta", [1.0, 0.3])
def test_a_free_body_resists_all_but_rigid_motion(smoothing_length, zeta):
    made = square(6, smoothing_length=smoothing_length, hourglass=zeta)
    matrix = undeformed(made)
    square_of_frequencies = np.linalg.eigvalsh(matrix)
    assert np.count_nonzero(np.abs(square_of_frequencies) < 1e-13 * largest(matrix)) == 3
    assert square_of_frequencies[3] > 0.01 * largest(matrix)
    x, y = reference(made)
    nothing = np.zeros_like(x)
    for rigid in ((nothing + 1.0, nothing), (nothing, nothing + 1.0), (-y, x)):
        assert largest(matrix @ np.concatenate(rigid)) < 1e-13 * largest(matrix)


def softest_shape(made):
    """The softest motion [2, count, count] that is not rigid, and its stiffness."""
    (value,), shape = eigh(undeformed(made), subset_by_index=(3, 3))
    side = round(np.sqrt(made.x.size))
    return shape.reshape(2, side, side), value


def test_without_hourglass_energy_a_free_body_hardly_resists_a_checkerboard():
    """Nothing inside resists it (see the energy's own tests), only the surface: the larger the less.

    With it the softest motion is the smooth one of an elastic body.
    """
    smooth, firm = softest_shape(square(8, smoothing_length=1.5))
    rough, soft = softest_shape(square(8, smoothing_length=1.5, hourglass=0.0))
    assert soft < 0.01 * firm
    _, softer = softest_shape(square(10, smoothing_length=1.5, hourglass=0.0))
    assert softer < 0.2 * soft
    for shape, alike in ((smooth, 1.0), (rough, -1.0)):
        for along in (1, 2):
            here, next_to_it = shape.take(range(7), along), shape.take(range(1, 8), along)
            assert alike * np.sum(here * next_to_it) > 0.5


@pytest.mark.parametrize("zeta", [1.0, 0.0])
def test_inside_a_lattice_only_hourglass_energy_resists_a_checkerboard(zeta):
    made = square(13, hourglass=zeta)
    checkerboard = (-1.0) ** np.sum(reference(made), axis=0)
    pulled = (undeformed(made) @ np.concatenate((checkerboard, 0.0 * checkerboard))).reshape(2, 13, 13)
    if zeta == 0.0:
        assert np.abs(pulled[:, 6, 6]).max() < 1e-14
    else:
        assert pulled[0, 6, 6] > 1.0
