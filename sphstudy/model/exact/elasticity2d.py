"""Two-dimensional elasticity by finite elements: what a perfect discretisation of the plate would find.

Nine-node quadrilaterals, the mesh graded towards wall and faces because the stress is singular at the
clamped corners. Every reference is computed on two meshes; the error estimate is their difference, which
bounds the error of the finer one.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy.sparse.linalg
import skfem
from skfem.models.elasticity import linear_elasticity

from sphstudy.model.material import Material

_GRADING = 2.5
_INSERT_GRADING = 4.0
"""Where a held face becomes a free one the stress is more singular than in a clamped corner."""

_MESHES = (8, 16)
"""Elements over the height, coarse and fine."""

_INSERT_MESHES = (12, 24)
"""The same for a plate with an insert, whose frequency converges more slowly."""


class Reference(NamedTuple):
    """A value and an estimate of its error, in the value's unit."""

    value: float
    error: float

    def times(self, unit: float) -> "Reference":
        """The same in another unit."""
        return Reference(self.value * unit, self.error * unit)


class BentPlate(NamedTuple):
    """Strain energy (J/m), angle of the end against the vertical (rad); centreline x, u_y (m)."""

    strain_energy: Reference
    end_angle: Reference
    x: np.ndarray
    u_y: np.ndarray


def plate_frequencies(
    length: float, height: float, material: Material, insert: float = 0.0
) -> tuple[Reference, Reference]:
    """The two lowest angular frequencies of a plate.

    Parameters
    ----------
    length, height : float
        Length beyond x = 0 and full height (m).
    material : Material
        The plate's.
    insert : float
        0: the plate is clamped at x = 0. Otherwise it goes on to x = -insert (m), with held faces and a
        free end there.

    Returns
    -------
    tuple of Reference
        ω1 and ω2 (rad/s).
    """
    unit = math.sqrt(material.youngs_modulus / material.density) / length
    first, second = _unit_frequencies(_ratio(height, length), _of_unit(material), _ratio(insert, length))
    return first.times(unit), second.times(unit)


@lru_cache
def _unit_frequencies(height: float, material: Material, insert: float) -> tuple[Reference, Reference]:
    meshes = _INSERT_MESHES if insert else _MESHES
    coarse, fine = (_frequencies(1.0, height, material, n, insert) for n in meshes)
    return _reference(coarse[0], fine[0]), _reference(coarse[1], fine[1])


def bent_plate(length: float, height: float, material: Material, deflection: float) -> BentPlate:
    """Statics of a plate clamped at x = 0, with u_y = deflection and u_x free on x = length; all in m."""
    unit = _unit_bent_plate(_ratio(height, length), _of_unit(material), _ratio(deflection, length))
    return BentPlate(
        unit.strain_energy.times(material.youngs_modulus * length**2),
        unit.end_angle,
        length * unit.x,
        length * unit.u_y,
    )


@lru_cache
def _unit_bent_plate(height: float, material: Material, deflection: float) -> BentPlate:
    coarse, fine = (_bent(1.0, height, material, deflection, n) for n in _MESHES)
    return BentPlate(_reference(coarse[0], fine[0]), _reference(coarse[1], fine[1]), fine[2], fine[3])


# Plates that differ in size, stiffness and density alone have one reference, to the last bit: rounding of
# the elements' matrices changes a frequency by some 1e-9 of itself.
def _of_unit(material: Material) -> Material:
    return material._replace(youngs_modulus=1.0, density=1.0)


def _ratio(length: float, unit: float) -> float:
    return float(f"{length / unit:.12g}")


def _reference(coarse: float, fine: float) -> Reference:
    return Reference(fine, abs(fine - coarse))


def _basis(length: float, height: float, elements: int, insert: float = 0.0) -> skfem.Basis:
    grading = _INSERT_GRADING if insert else _GRADING
    along = length * np.linspace(0.0, 1.0, 5 * elements + 1) ** grading
    if insert:
        inside = insert * np.linspace(1.0, 0.0, 2 * elements + 1) ** grading
        along = np.concatenate((-inside[:-1], along))
    across = np.linspace(-1.0, 1.0, elements + 1)
    faces = np.sign(across) * (1.0 - (1.0 - np.abs(across)) ** grading)
    mesh = skfem.MeshQuad.init_tensor(along, 0.5 * height * faces)
    return skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()), intorder=4)


def _stiffness(basis: skfem.Basis, material: Material) -> scipy.sparse.csc_matrix:
    form = linear_elasticity(material.lame_modulus, material.shear_modulus)
    return form.assemble(basis).tocsc()


@skfem.BilinearForm
def _product(u, v, _):
    return u[0] * v[0] + u[1] * v[1]


@skfem.Functional
def _first_moment(w):
    return w.x[1] * w["u"][0]


def _near(x: np.ndarray, place: float, height: float) -> np.ndarray:
    """Mask of the coordinates that are a place, but for rounding, whatever the size of the body."""
    return np.abs(x - place) < 1e-9 * height


def _held(basis: skfem.Basis, height: float, insert: float) -> np.ndarray:
    """Degrees of freedom that the clamp holds."""
    if not insert:
        return basis.get_dofs(lambda x: _near(x[0], 0.0, height)).all()
    return basis.get_dofs(lambda x: _near(np.abs(x[1]), 0.5 * height, height) & (x[0] < 0.0)).all()


def _frequencies(
    length: float, height: float, material: Material, elements: int, insert: float = 0.0
) -> list[float]:
    basis = _basis(length, height, elements, insert)
    mass = material.density * _product.assemble(basis).tocsc()
    free = basis.complement_dofs(_held(basis, height, insert))
    squares = scipy.sparse.linalg.eigsh(
        _stiffness(basis, material)[free][:, free],
        k=2,
        M=mass[free][:, free],
        sigma=0.0,
        v0=np.ones(free.size),
        return_eigenvectors=False,
    )
    return np.sqrt(np.sort(squares)).tolist()


def _bent(
    length: float, height: float, material: Material, deflection: float, elements: int
) -> tuple[float, float, np.ndarray, np.ndarray]:
    basis = _basis(length, height, elements)
    stiffness = _stiffness(basis, material)
    wall = basis.get_dofs(lambda x: _near(x[0], 0.0, height)).all()
    end = basis.get_dofs(lambda x: _near(x[0], length, height)).all()
    # Degrees of freedom alternate: x and y displacement of one node after the other.
    driven = end[end % 2 == 1]
    u = basis.zeros()
    u[driven] = deflection
    u = skfem.solve(*skfem.condense(stiffness, x=u, D=np.concatenate((wall, driven))))
    # Integrals, not a fit to the nodes: these crowd at the faces and would weigh the warping there.
    face = basis.boundary(basis.mesh.facets_satisfying(lambda x: _near(x[0], length, height)))
    moment = _first_moment.assemble(face, u=face.interpolate(u))
    slope = moment / (height**3 / 12.0)
    upward = np.arange(1, u.size, 2)
    middle = upward[_near(basis.doflocs[1, upward], 0.0, height)]
    middle = middle[np.argsort(basis.doflocs[0, middle])]
    energy = float(0.5 * u @ (stiffness @ u))
    return energy, float(-np.arctan(slope)), basis.doflocs[0, middle], u[middle]
