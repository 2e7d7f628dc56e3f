"""Steady rotation of a square by Ritz's method, against finite elements."""

import numpy as np
import pytest
import skfem
from skfem.models.elasticity import linear_elasticity

from sphstudy.model.exact import spinning_square as module
from sphstudy.model.exact.spinning_square import spinning_square
from sphstudy.model.material import Material

RUBBER = Material(1.7e7, 0.45, 1100.0, "strain")
SHEET = Material(1.7e7, 0.3, 1100.0, "stress")


@skfem.LinearForm
def _centrifugal(v, w):
    return w.x[0] * v[0] + w.x[1] * v[1]


def by_finite_elements(side, rate, material, elements=20):
    """Gains of a corner's distance and of the moment of inertia, from a quarter of the square."""
    line = 0.5 * side * np.linspace(0.0, 1.0, elements + 1)
    basis = skfem.Basis(skfem.MeshQuad.init_tensor(line, line), skfem.ElementVector(skfem.ElementQuad2()))
    stiffness = linear_elasticity(material.lame_modulus, material.shear_modulus).assemble(basis)
    outward = _centrifugal.assemble(basis)
    held = [basis.get_dofs(lambda x, a=a: np.isclose(x[a], 0.0)).all()[a::2] for a in (0, 1)]
    load = material.density * rate**2 * outward
    u = skfem.solve(*skfem.condense(stiffness, load, D=np.concatenate(held)))
    corner = np.isclose(basis.doflocs, 0.5 * side).all(axis=0)
    return float(u[corner].mean()) / (0.5 * side), 4.0 * 2.0 * float(outward @ u) / (side**4 / 6.0)


@pytest.mark.parametrize("material", [RUBBER, SHEET])
def test_finite_elements_agree(material):
    found = spinning_square(2.0, 30.0, material)
    corner, inertia = by_finite_elements(2.0, 30.0, material)
    assert found.corner_stretch.value == pytest.approx(corner, rel=2e-4)
    assert found.inertia_gain.value == pytest.approx(inertia, rel=1e-5)
    assert found.corner_stretch.error < 1e-4 * corner


def test_error_estimate_bounds_the_distance_to_a_higher_degree():
    found = spinning_square(1.0, 50.0, RUBBER)
    finer = module._solved(1.0, 50.0, RUBBER, 12)
    assert abs(found.corner_stretch.value - finer[0]) < found.corner_stretch.error
    assert abs(found.inertia_gain.value - finer[1]) < found.inertia_gain.error
