"""The finite-element references against published values and the slender limit."""

import numpy as np
import pytest
import scipy.sparse.linalg
import skfem
from scipy.interpolate import make_interp_spline

from sphstudy.model.exact import beam, elasticity2d
from sphstudy.model.exact.elasticity2d import bent_plate, plate_frequencies
from sphstudy.model.material import Material


# From quadratic elements on two meshes that agreed to 1e-5; the last two are printed with fewer digits.
@pytest.mark.parametrize(
    ("plane", "nu", "omega", "tolerance"),
    [
        ("strain", 0.3, 1.003081, 1e-5),
        ("stress", 0.3, 0.956428, 1e-5),
        ("strain", 0.45, 1.07459, 2e-5),
        ("strain", 0.49, 1.1026, 6e-5),
    ],
)
def test_frequency_of_the_thesis_plate(plane, nu, omega, tolerance):
    reference = plate_frequencies(1.0, 1.0 / 12.0, Material(1e6, nu, 7750.0, plane))[0]
    assert reference.value == pytest.approx(omega, abs=tolerance)


@pytest.mark.parametrize(("plane", "omega"), [("strain", 6.0821), ("stress", 5.8112)])
def test_second_frequency_of_the_thesis_plate(plane, omega):
    second = plate_frequencies(1.0, 1.0 / 12.0, Material(1e6, 0.3, 7750.0, plane))[1]
    assert second.value == pytest.approx(omega, abs=1e-4)


@pytest.mark.parametrize("nu", [0.3, 0.49, pytest.param(0.495, marks=pytest.mark.slow)])
def test_error_estimate_bounds_the_distance_to_a_finer_mesh(nu):
    material = Material(1e6, nu, 7750.0, "strain")
    reference = plate_frequencies(1.0, 1.0 / 12.0, material)[0]
    finer = elasticity2d._frequencies(1.0, 1.0 / 12.0, material, 24)[0]
    assert 0.0 < abs(reference.value - finer) < reference.error < 2e-4 * finer


GRAY = Material(2e6, 0.3975, 1000.0, "strain")


def gray_period(insert):
    omega = plate_frequencies(0.2, 0.02, GRAY, insert)[0]
    return 2.0 * np.pi / omega.value, 2.0 * np.pi / omega.value * omega.error / omega.value


def test_period_of_gray_monaghan_and_swifts_plate():
    period, error = gray_period(0.0)
    assert period == pytest.approx(0.2552, abs=5e-5)
    assert error < 0.03 * 0.003 * period


@pytest.mark.parametrize(("insert", "period"), [(0.01, 0.26313), (0.02, 0.26280)])
def test_insert_lengthens_the_period_and_a_shorter_one_more(insert, period):
    """From meshes three times as fine; the next test confirms the second with other elements."""
    omega = elasticity2d._frequencies(0.2, 0.02, GRAY, 8, insert)[0]
    assert 2.0 * np.pi / omega == pytest.approx(period, abs=2e-4)


def triangles_with_an_insert(refinements):
    """The same period by quadratic triangles, refined again and again where the held faces end."""
    mesh = skfem.MeshTri.init_tensor(np.linspace(-0.02, 0.2, 45), np.linspace(-0.01, 0.01, 5))
    for k in range(refinements):
        x, y = mesh.p[:, mesh.t].mean(axis=1)
        reach = 0.008 * 0.6**k
        mesh = mesh.refined(np.flatnonzero(np.hypot(x, np.abs(y) - 0.01) < reach))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTriP2()), intorder=4)
    held = basis.get_dofs(lambda x: np.isclose(np.abs(x[1]), 0.01) & (x[0] < 0.0))
    free = basis.complement_dofs(held)
    stiffness = elasticity2d._stiffness(basis, GRAY)[free][:, free]
    mass = 1000.0 * elasticity2d._product.assemble(basis).tocsc()[free][:, free]
    square = scipy.sparse.linalg.eigsh(
        stiffness, k=1, M=mass, sigma=0.0, v0=np.ones(free.size), return_eigenvectors=False
    )
    return float(2.0 * np.pi / np.sqrt(square[0]))


@pytest.mark.slow
def test_insert_lengthens_the_period_as_much_as_other_elements_say():
    period, error = gray_period(0.02)
    assert error < 2e-4 * period
    assert abs(period - triangles_with_an_insert(10)) < error


def test_slender_plate_in_plane_stress_is_a_beam():
    plate = plate_frequencies(1.0, 0.01, Material(1e6, 0.3, 7750.0, "stress"))[0]
    assert plate.value == pytest.approx(beam.fundamental_frequency(1e6, 7750.0, 1.0, 0.01), rel=5e-4)


@pytest.mark.parametrize(("plane", "energy"), [("strain", 0.126787), ("stress", 0.115284)])
def test_energy_of_the_bent_plate(plane, energy):
    bent = bent_plate(1.0, 1.0 / 12.0, Material(1e6, 0.3, 7750.0, plane), -0.04)
    assert bent.strain_energy.value == pytest.approx(energy, rel=5e-5)
    assert bent.strain_energy.error < 1e-4 * energy


def test_centreline_of_the_bent_plate():
    bent = bent_plate(1.0, 1.0 / 12.0, Material(1e6, 0.3, 7750.0, "strain"), -0.04)
    u_y = make_interp_spline(bent.x, bent.u_y)([0.0, 0.25, 0.5, 0.75, 1.0])
    expected = [0.0, -3.44952e-3, -1.251783e-2, -2.532438e-2, -0.04]
    np.testing.assert_allclose(u_y, expected, atol=1e-6)


def test_end_angle_tends_to_the_beam():
    bent = bent_plate(1.0, 0.01, Material(1e6, 0.3, 7750.0, "stress"), -0.01)
    assert bent.end_angle.value == pytest.approx(np.arctan(beam.end_angle(-0.01, 1.0, 0.0)), rel=1e-3)


# Spectral elements on a mesh graded geometrically towards the clamped corners; angles of the line that
# fits the end in the mean square over the height.
@pytest.mark.parametrize(("plane", "angle"), [("strain", -0.05963127), ("stress", -0.05963627)])
def test_end_angle_weighs_the_end_evenly(plane, angle):
    bent = bent_plate(1.0, 1.0 / 12.0, Material(1e6, 0.3, 7750.0, plane), -0.04)
    assert abs(bent.end_angle.value - angle) < bent.end_angle.error
    assert bent.end_angle.error < 1e-6
