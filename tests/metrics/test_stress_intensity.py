"""Stress intensities of a record: from Williams' field put into one, whatever the method says it is."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.catalogue import scene_module
from sphstudy.configuration.composition import session
from sphstudy.metrics import stress_intensity
from sphstudy.model.exact import williams
from sphstudy.numerics.solvers.solution import FIELDS, Snapshot, Solution
from sphstudy.numerics.sph import constitutive
from sphstudy.store.record import fields

E, NU, K = 6e6, 0.3, 35.8e3


def record(settings, displacement, stress):
    """A settled state with this displacement [2, N] and Cauchy stress [3, N]."""
    with session() as hydra:
        config = hydra.points(settings, sweep=False)[0][0].config
    problem = scene_module("crack").build(config)
    body, state = problem.body, np.zeros((len(FIELDS), problem.body.x.size))
    state[:2] = np.stack((body.x, body.y)) + displacement(body)
    state[-3:] = stress(body)
    return fields(problem, Solution(snapshots=[Snapshot("settle", 0.0, 0, state, 0.0)])), config


def measured(settings, displacement, stress):
    found = stress_intensity.measure(*record(settings, displacement, stress))
    return {name: metric.value for name, metric in found.items()}, found


def williams_record(mode, factor=1.0, settings=("n=60",)):
    return (
        [f"scene=mode{mode}", "method=tl", "h=1.3", *settings],
        lambda body: williams.displacement(mode, body.x, body.y, factor * K, E, NU),
        lambda body: williams.stress(mode, body.x, body.y, factor * K),
    )


@pytest.mark.parametrize("mode", [1, 2])
@pytest.mark.parametrize("factor", [1.0, 0.8])
def test_williams_field_has_its_stress_intensity(mode, factor):
    """Here gradients come from particles: their error, not that of the quadrature, is left."""
    values, _ = measured(*williams_record(mode, factor))
    same, other = ("K_I", "K_II") if mode == 1 else ("K_II", "K_I")
    assert values[f"{same}_integral_error"] == pytest.approx(factor - 1.0, abs=3e-4)
    assert abs(values[f"{other}_integral_error"]) < 1e-12
    assert values["J_error"] == pytest.approx(factor**2 - 1.0, abs=3e-4)
    assert values[f"{same}_contour_spread"] < 1e-3


def test_a_rigid_rotation_has_no_release_rate():
    """Of any angle, where the law does not mind: P and F, not small strain, enter J."""
    angle = 0.7

    def turned(body):
        cosine, sine = np.cos(angle), np.sin(angle)
        return (
            (cosine - 1.0) * body.x - sine * body.y,
            sine * body.x + (cosine - 1.0) * body.y,
        )

    values, _ = measured(
        ["scene=mode1", "method=tl", "h=1.3", "method.law=svk"],
        turned,
        lambda body: np.zeros((3, body.x.size)),
    )
    assert abs(values["J"]) < 1e-6


def test_stress_of_finite_strain_becomes_first_piola_kirchhoff():
    """Homogeneous stretch with shear: P = J σ F⁻ᵀ must be what the law says of F."""
    f = np.array([[1.2, 0.3], [-0.1, 0.9]])
    with session() as hydra:
        settings = ["scene=mode1", "method=tl", "h=1.3", "method.law=neohookean"]
        config = hydra.points(settings, sweep=False)[0][0].config
    body = scene_module("crack").build(config).body
    law = constitutive.law("neohookean", body.material)
    expected = np.array(constitutive.stress(law, *f.ravel())).reshape(2, 2)
    cauchy = expected @ f.T / np.linalg.det(f)
    np.testing.assert_allclose(cauchy, cauchy.T, rtol=1e-12)
    count = body.x.size
    state = xr.Dataset(
        {
            name: ("particle", np.full(count, value))
            for name, value in zip(
                ("stress_xx", "stress_yy", "stress_xy"),
                (cauchy[0, 0], cauchy[1, 1], cauchy[0, 1]),
                strict=True,
            )
        }
    )
    gradient = np.repeat(f.ravel()[:, None], count, axis=1)
    stress, density = stress_intensity._stress_and_energy(body.material, config, state, gradient)
    np.testing.assert_allclose(stress[:, 0], expected.ravel(), rtol=1e-12)
    assert density[0] == pytest.approx(constitutive.energy_density(law, *f.ravel()))


def test_an_annulus_that_does_not_fit_is_said_and_leaves_no_number():
    values, found = measured(*williams_record(1, settings=("n=20",)))
    assert np.isnan([values["K_I_integral"], values["K_II_integral"], values["J"]]).all()
    assert "inner radius" in found["K_I_integral"].remark


@pytest.mark.parametrize(("h", "fits"), [(1.99, True), (2.01, False)])
def test_the_support_may_just_touch_the_annulus(h, fits):
    """n = 40: the inner radius is four spacings, the support of the cubic spline 2h."""
    settings, *fields = williams_record(1, settings=("n=40",))
    values, _ = measured([f"h={h}" if s.startswith("h=") else s for s in settings], *fields)
    assert np.isfinite(values["K_I_integral"]) == fits
