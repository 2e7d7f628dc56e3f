"""The checkerboard: how it is set up, and which methods feel it."""

import numpy as np
import pytest

import sphstudy
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.model.exact.waves import checkerboard_stiffness
from sphstudy.model.material import Material
from sphstudy.model.scenes import checkerboard
from sphstudy.numerics.solvers.indicators import Indicators


def test_pattern_alternates_inside_and_fades_at_the_surface():
    found = checkerboard.pattern(20).reshape(20, 20)
    assert np.abs(found).max() == pytest.approx(1.0, abs=0.02)
    assert np.abs(found[[0, -1]]).max() < 0.01
    signs = np.sign(found)
    assert (signs[:, 1:] == -signs[:, :-1]).all()
    assert (signs[1:] == -signs[:-1]).all()


@pytest.mark.parametrize("n", [20, 21])
def test_every_particle_is_driven_into_it(n):
    with session() as hydra:
        config = hydra.points(["scene=checkerboard", f"n={n}"], sweep=False)[0][0].config
    problem = checkerboard.build(config)
    body, constraints = problem.body, problem.constraints
    assert constraints.x_index.tolist() == constraints.y_index.tolist() == list(range(n * n))
    assert np.abs(constraints.x_target).max() == pytest.approx(0.05 / n, rel=0.02)
    assert not constraints.y_target.any()
    assert np.hypot(body.x, body.y)[problem.tracked] < 1.0 / n
    moved = np.stack((body.x + constraints.x_target, body.y))
    assert Indicators(problem).measure(moved).hourglass_share > 0.95


def test_solvers_that_need_free_particles_are_refused():
    with session() as hydra, pytest.raises(ConfigurationError, match="leaves no particle free"):
        hydra.points(["scene=checkerboard", "method=tl", "solve=equilibrium"], sweep=False)


def laplacian_stiffness(h, material):
    """4ζµ Σ w over the neighbours of the other sign [Pa], ζ = 1: on an infinite lattice F = I, and the
    hourglass energy alone resists. Cubic spline by its pieces.
    """
    column, row = np.meshgrid(np.arange(-5, 6), np.arange(-5, 6))
    q = np.hypot(column, row) / h
    slope = np.where(q < 1.0, 1.5 * q**2 - 2.0 * q, -0.5 * np.clip(2.0 - q, 0.0, None) ** 2)
    other = (column + row) % 2 == 1
    weight = -slope[other] * 15.0 / (7.0 * np.pi * h**2) / (q[other] * h**2)
    return 4.0 * material.shear_modulus * float(weight.sum())


@pytest.mark.slow
def test_only_the_hourglass_energy_resists(tmp_path):
    common = {"scene": "checkerboard", "n": 24, "h": 1.3, "results": tmp_path}
    material = Material(1e6, 0.3, 7750.0, "strain")
    expected = laplacian_stiffness(1.3, material) / checkerboard_stiffness(material)
    resisted = sphstudy.run(method="tl", **common)
    assert float(resisted["restoring_ratio"]) == pytest.approx(expected, rel=1e-3)
    assert float(resisted["work_ratio"]) == pytest.approx(expected, rel=1e-3)
    rates = sphstudy.run(method="thesis", **common)
    assert abs(float(rates["restoring_ratio"])) < 1e-3 * expected
