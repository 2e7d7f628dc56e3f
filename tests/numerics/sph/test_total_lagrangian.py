"""Total Lagrangian energy and force: brute-force twin, energy gradient, exactness, conservation."""

import re

import numpy as np
import pytest

from sphstudy.model.material import Material
from sphstudy.numerics.sph import constitutive, total_lagrangian, viscosity
from sphstudy.numerics.sph.kernel import KERNELS
from sphstudy.numerics.sph.viscosity import Viscosity
from tests.numerics.sph import test_bonds
from tests.numerics.sph.clouds import FREE, lattice_positions, middle_crack
from tests.numerics.sph.test_bonds import SMOOTHING_LENGTH, every_kernel
from tests.numerics.sph.test_constitutive import UNDEFORMED, derivative, rotation

CUBIC = KERNELS["cubic"]
DENSITY, SHEAR_MODULUS = 1.7, 2.0 / 2.6
AFFINE = np.array([[1.1, 0.15], [-0.05, 0.92]])
ANGLES = (0.1, 1.3, 3.0)

# Every law costs a compilation of everything: most are looked at with the JIT off only.
LINEAR = pytest.param("linear", "stress", id="linear")
SVK = pytest.param("svk", "strain", id="svk")
NEO_HOOKEAN = [
    pytest.param("neohookean", plane, id=f"neohookean {plane}", marks=pytest.mark.interpreted)
    for plane in ("strain", "stress")
]
every_law = pytest.mark.parametrize(("name", "plane"), [LINEAR, SVK, *NEO_HOOKEAN])
every_objective_law = pytest.mark.parametrize(("name", "plane"), [SVK, *NEO_HOOKEAN])
every_body = pytest.mark.parametrize("body", ["cloud", "lattice", "mixed"])


def modelled(
    positions,
    volume,
    shape=CUBIC,
    smoothing_length=SMOOTHING_LENGTH,
    name="svk",
    plane="strain",
    constraints=FREE,
    **choices,
):
    """A body with Young's modulus 2 and Poisson's ratio 0.3."""
    return total_lagrangian.model(
        *positions,
        DENSITY * volume,
        DENSITY,
        shape,
        smoothing_length,
        constitutive.law(name, Material(2.0, 0.3, DENSITY, plane)),
        constraints,
        **choices,
    )


def cracked(body, rng, **choices):
    """A body of test_bonds with a crack."""
    positions, volume = test_bonds.named(body, rng)
    return modelled(positions, volume, crack=middle_crack(positions), **choices)


def square(count, **choices):
    """A square lattice of unit spacing."""
    return modelled(lattice_positions(count, count), np.ones(count * count), **choices)


def reference(made):
    return np.stack((made.x, made.y))


def stretched(made):
    """Positions [2, N] after an affine motion: stretch, shear and translation."""
    return AFFINE @ reference(made) + [[3.0], [-7.0]]


def deformed(made, rng):
    """Positions [2, N] far from the reference: an affine motion, a turn, and a jitter."""
    return rotation(1.0) @ stretched(made) + rng.uniform(-0.04, 0.04, (2, made.x.size))


def gradient(made, positions):
    """F [4, N]."""
    found = np.full((4, made.x.size), np.nan)
    total_lagrangian.deformation_gradient(None, made, *positions, found)
    return found


def force(made, positions):
    """f [2, N]."""
    found = np.full((2, made.x.size), np.nan)
    total_lagrangian.force(made, *positions, total_lagrangian.workspace(made.x.size), found)
    return found


def energies(made, positions):
    """Strain and hourglass energy; nothing here touches."""
    work = total_lagrangian.workspace(made.x.size)
    *found, touching = total_lagrangian.energies(made, *positions, work)
    assert touching == 0.0
    return np.array(found)


def viscous_force(made, positions, velocity):
    """f [2, N] of the artificial viscosity alone."""
    found = np.zeros((2, made.x.size))
    viscosity.add_forces(made.viscosity, made, *velocity, *positions, found)
    return found


def differences(values):
    """Of values [2, N], that of j less that of i [2, N, N]."""
    return values[:, None, :] - values[:, :, None]


def twin(made, weight, apart, positions, zeta):
    """F [N, 2, 2], energies and force from the formulas: sums over all pairs, no symmetry used."""
    now, stiffness = differences(positions), zeta * SHEAR_MODULUS
    inverse = np.linalg.inv(np.einsum("ij,aij,bij->iab", weight, apart, apart))
    f = np.einsum("ij,aij,bij,ibc->iac", weight, now, apart, inverse)
    components = f.reshape(-1, 4).T
    first = constitutive.stresses(made.law, components).T.reshape(-1, 2, 2)
    flux = made.volume[:, None, None] * (first @ inverse) - stiffness * f
    both = flux[:, None] + flux[None, :]
    total = np.einsum("ij,ijab,bij->ai", weight, both, apart)
    total += 2.0 * stiffness * np.einsum("ij,aij->ai", weight, now)
    misfit = now - np.einsum("iab,bij->aij", f, apart)
    strain = made.volume @ constitutive.energy_densities(made.law, components)
    hourglass = 0.5 * stiffness * np.sum(weight * misfit**2)
    return components, np.array([strain, hourglass]), total


def assert_equals_twin(body, rng, shape=CUBIC, zeta=1.0, **choices):
    positions, volume = test_bonds.named(body, rng)
    crack = middle_crack(positions)
    made = modelled(positions, volume, shape, crack=crack, hourglass=zeta, **choices)
    weight, apart = test_bonds.twin(positions, volume, shape, crack)
    positions = deformed(made, rng)
    f, energy, total = twin(made, weight, apart, positions, zeta)
    np.testing.assert_allclose(gradient(made, positions), f, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(energies(made, positions), energy, rtol=1e-12)
    np.testing.assert_allclose(force(made, positions), total, rtol=0.0, atol=1e-12 * np.abs(total).max())


@every_law
@every_body
def test_equals_the_brute_force_twin(rng, body, name, plane):
    assert_equals_twin(body, rng, name=name, plane=plane)


@every_kernel
def test_equals_the_brute_force_twin_with_every_kernel(rng, shape):
    assert_equals_twin("mixed", rng, shape=shape, zeta=0.3)


@pytest.mark.interpreted
@every_body
def test_equals_the_brute_force_twin_without_hourglass_energy(rng, body):
    assert_equals_twin(body, rng, zeta=0.0)


@every_body
def test_viscosity_equals_its_brute_force_twin(rng, body):
    """(2.21) on the line between the particles as they stand; densities that differ, to tell i from j."""
    positions, volume = test_bonds.named(body, rng)
    made = modelled(positions, volume, viscous=Viscosity(1.2, 2.3), wave_speed=0.7)
    made = made._replace(mass=made.mass * rng.uniform(0.5, 1.5, volume.size))
    weight, _ = test_bonds.twin(positions, volume, CUBIC, None)
    positions, velocity = deformed(made, rng), rng.normal(size=positions.shape)
    now, density = differences(positions), made.mass / volume
    approach = np.minimum(np.sum(now * differences(velocity), axis=0), 0.0)
    phi = SMOOTHING_LENGTH * approach / (np.sum(now**2, axis=0) + (0.1 * SMOOTHING_LENGTH) ** 2)
    mean = 0.5 * (density[:, None] + density[None, :])
    pressure = (-1.2 * 0.7 * phi + 2.3 * phi**2) / mean
    expected = -np.sum(weight * np.outer(density, density) * pressure * now, axis=2)
    np.testing.assert_allclose(
        viscous_force(made, positions, velocity),
        expected,
        rtol=0.0,
        atol=1e-12 * np.abs(expected).max(),
    )


def assert_gradient_of_energy(made, rng):
    """In random directions, each of which moves every particle."""
    positions = deformed(made, rng)
    total, scale = force(made, positions), np.abs(force(made, positions)).max()
    for _ in range(4):
        direction = rng.uniform(-1.0, 1.0, positions.shape)
        slope = derivative(lambda s, d=direction: energies(made, positions + s * d).sum(), 1e-3)
        assert -slope == pytest.approx(np.sum(total * direction), rel=0.0, abs=1e-7 * scale)


@every_law
def test_force_is_minus_the_gradient_of_the_energy(rng, name, plane):
    assert_gradient_of_energy(cracked("mixed", rng, name=name, plane=plane), rng)


@pytest.mark.interpreted
@pytest.mark.parametrize(("name", "plane"), [("linear", "strain"), ("svk", "stress")])
@pytest.mark.parametrize("zeta", [0.0, 0.3])
def test_force_is_minus_the_gradient_of_the_energy_in_the_other_planes(rng, name, plane, zeta):
    assert_gradient_of_energy(cracked("mixed", rng, name=name, plane=plane, hourglass=zeta), rng)


@every_body
@every_kernel
def test_deformation_gradient_of_an_affine_motion_is_exact_everywhere(rng, body, shape):
    """Beside crack and surface too."""
    made = cracked(body, rng, shape=shape)
    expected = np.broadcast_to(AFFINE.reshape(4, 1), (4, made.x.size))
    np.testing.assert_allclose(gradient(made, stretched(made)), expected, rtol=0.0, atol=1e-12)


@every_body
def test_affine_motion_has_no_hourglass_energy(rng, body):
    made = cracked(body, rng)
    strain, hourglass = energies(made, stretched(made))
    assert hourglass < 1e-25
    uniform = constitutive.energy_densities(made.law, AFFINE.reshape(4, 1))
    assert strain == pytest.approx(made.volume.sum() * uniform[0], rel=1e-12)


@every_law
def test_uniform_stress_pulls_at_surfaces_only(name, plane):
    """Farther than two supports from any surface the neighbours' corrections are all alike."""
    count = 15
    made = square(count, name=name, plane=plane)
    total = np.hypot(*force(made, stretched(made)))
    inside = np.minimum(reference(made), count - 1 - reference(made)).min(axis=0)
    deep = inside > 2 * CUBIC.support * SMOOTHING_LENGTH
    assert np.count_nonzero(deep) == 9
    assert total[deep].max() < 1e-12 * total.max()
    assert total[inside == 0].min() > 0.01 * total.max()


@every_objective_law
@pytest.mark.parametrize("angle", ANGLES)
@every_body
def test_rigid_rotation_costs_an_objective_law_nothing(rng, body, name, plane, angle):
    made = cracked(body, rng, name=name, plane=plane)
    typical = np.abs(force(made, stretched(made))).max()
    turned = rotation(angle) @ reference(made)
    assert np.abs(force(made, turned)).max() < 1e-13 * typical
    assert abs(energies(made, turned).sum()) < 1e-13


@pytest.mark.parametrize("angle", ANGLES)
def test_rigid_rotation_strains_under_the_linear_law(rng, angle):
    made = cracked("cloud", rng, name="linear", plane="stress")
    turned = rotation(angle) @ reference(made)
    assert np.abs(force(made, turned)).max() > 0.001 * SHEAR_MODULUS


def resultants(positions, total):
    """Sum and torque of forces, each relative to what it is the difference of."""
    torque = positions[0] * total[1] - positions[1] * total[0]
    arms = np.hypot(*positions) @ np.hypot(*total)
    return np.abs(total.sum(axis=1)).max() / np.hypot(*total).sum(), np.abs(torque.sum()) / arms


@every_law
@every_body
def test_internal_forces_keep_both_momenta(rng, body, name, plane):
    made = cracked(body, rng, name=name, plane=plane)
    positions = deformed(made, rng)
    net, torque = resultants(positions, force(made, positions))
    assert net < 1e-13
    if made.law.objective:
        assert torque < 1e-13
    else:
        assert torque > 1e-3, "the linear law should take the turn for a strain"


@every_body
def test_viscosity_keeps_both_momenta(rng, body):
    made = cracked(body, rng, viscous=Viscosity(1.0, 2.0), wave_speed=1.0)
    positions, velocity = deformed(made, rng), rng.normal(size=(2, made.x.size))
    found = viscous_force(made, positions, velocity)
    assert np.abs(found).max() > 0.1
    assert max(resultants(positions, found)) < 1e-13
    assert max(resultants(positions, force(made, positions) + found)) < 1e-13


def test_viscosity_takes_energy_and_rests_when_particles_separate(rng):
    made = cracked("mixed", rng, viscous=Viscosity(1.0, 2.0), wave_speed=1.0)
    for _ in range(20):
        positions, velocity = deformed(made, rng), rng.normal(size=(2, made.x.size))
        assert np.sum(velocity * viscous_force(made, positions, velocity)) < 0.0
    assert np.abs(viscous_force(made, positions, positions)).max() == 0.0


def test_only_the_hourglass_energy_notices_a_checkerboard():
    """Neighbours on opposite sides move alike: their pulls cancel in the deformation gradient."""
    made = square(11)
    column, row = reference(made)
    checkerboard = np.stack((0.01 * (-1.0) ** (column + row), np.zeros_like(row)))
    positions = reference(made) + checkerboard
    inside = np.minimum(reference(made), 10 - reference(made)).min(axis=0) >= 3
    f = gradient(made, positions)
    np.testing.assert_allclose(f[:, inside], np.tile(UNDEFORMED, 25), rtol=0.0, atol=1e-15)
    assert constitutive.energy_densities(made.law, f[:, inside]).max() < 1e-28
    strain, hourglass = energies(made, positions)
    assert hourglass > strain
    centre = 60
    pulled = force(made, positions)[0, centre]
    weight, _ = test_bonds.twin(reference(made), made.volume, CUBIC, None)
    moved = checkerboard[0] - checkerboard[0, centre]
    assert pulled == pytest.approx(2.0 * SHEAR_MODULUS * weight[centre] @ moved, rel=1e-11)
    assert pulled * checkerboard[0, centre] < 0.0


@pytest.mark.interpreted
def test_without_hourglass_energy_a_checkerboard_meets_no_resistance():
    made = square(13, hourglass=0.0)
    column, row = reference(made)
    positions = reference(made) + 0.01 * (-1.0) ** (column + row)
    assert energies(made, positions)[1] == 0.0
    total = np.abs(force(made, positions)).max(axis=0).reshape(13, 13)
    assert total[6, 6] < 1e-14
    assert total.max() > 1e-4


def test_neighbours_on_a_line_are_refused():
    """On a slant, where rounding keeps the determinant from being zero."""
    along = 0.7 * np.arange(10.0)
    positions = np.stack((2.0 + np.cos(0.5) * along, 5.0 + np.sin(0.5) * along))
    with pytest.raises(ValueError, match=re.escape("10 particles without enough")) as refused:
        modelled(positions, np.ones(10))
    assert "(2, 5) m" in str(refused.value)


def test_a_lonely_particle_is_named():
    positions = lattice_positions(5, 5)
    positions[:, 17] = 40.0, -30.5
    with pytest.raises(ValueError, match=re.escape("the first at (40, -30.5) m")) as refused:
        modelled(positions, np.ones(25))
    assert str(refused.value).startswith("1 particles")


def test_two_rows_are_enough():
    made = modelled(lattice_positions(6, 2), np.ones(12))
    assert np.isfinite(made.correction).all()


def test_inverted_counts_what_is_not_the_right_way_round():
    found = np.tile(UNDEFORMED, 6)
    found[:, 1] = 1.0, 0.0, 0.0, -0.1
    found[:, 3] = 1.0, 2.0, 0.5, 1.0
    found[:, 4] = np.nan
    found[:, 5] = rotation(3.0).ravel()
    for name, expected in (("linear", 0), ("svk", 3), ("neohookean", 3)):
        law = constitutive.law(name, Material(2.0, 0.3, 1.0, "strain"))
        assert total_lagrangian.inverted(law, found) == expected


def test_terms_that_are_zero_are_left_out():
    bare, full = square(5, hourglass=0.0, damping=0.0), square(5, hourglass=0.3, damping=0.5)
    assert bare.hourglass is None
    assert bare.damping is None
    assert full.hourglass == pytest.approx(0.3 * SHEAR_MODULUS, rel=1e-15)
    assert full.damping == 0.5
    np.testing.assert_allclose(full.volume, 1.0, rtol=1e-15)
