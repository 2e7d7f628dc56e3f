"""Sparse tangent stiffness of the total Lagrangian energy.

With the sparse operators G_b of the corrected gradient, F_ab = Σ_j (G_b)_ij x_j,a, and the hourglass
matrix S, the same for both components, of ½ ζ µ Σ w |x_ij - F_i X_ij|² = ½ Σ_a x_aᵀ S x_a,

    K_ac = Σ_bd G_bᵀ V (∂P_ab/∂F_cd) G_d + S δ_ac.

S is the Laplacian of the bonds less Gᵀ L⁻¹ G, because the moments Σ_j w x_ij ⊗ X_ij are F_i L_i⁻¹.
"""

from typing import NamedTuple

import numpy as np
import scipy.sparse as sparse

from sphstudy.numerics.sph import bonds, constitutive
from sphstudy.numerics.sph.total_lagrangian import Model, moments


class Operators(NamedTuple):
    """gradient: G_x above G_y [2N, N] (1/m); hourglass: S [N, N] (Pa), or None."""

    gradient: sparse.csr_array
    hourglass: sparse.csr_array | None


def operators(model: Model) -> Operators:
    """The linear operators of a model, which its deformation does not change."""
    count = model.x.size
    first, second, weight, x, y = bonds.as_pairs(model.bonds)
    l_xx, l_xy, l_yy = model.correction
    rows, columns = np.concatenate((first, second)), np.concatenate((second, first))
    # w X_ij seen from i, and from j, whose vector and neighbour's difference both change sign.
    along, across = np.tile(weight * x, 2), np.tile(weight * y, 2)
    sign = np.repeat((1.0, -1.0), first.size)
    parts = []
    for a, b in ((l_xx, l_xy), (l_xy, l_yy)):
        values = sign * (along * a[rows] + across * b[rows])
        diagonal = -np.bincount(rows, values, minlength=count)
        parts.append(_square(rows, columns, values, diagonal))
    gradient = sparse.vstack(parts, format="csr")
    if model.hourglass is None:
        return Operators(gradient, None)
    doubled = np.tile(weight, 2)
    laplacian = _square(rows, columns, -2.0 * doubled, 2.0 * np.bincount(rows, doubled, minlength=count))
    xx, xy, yy = moments(model.bonds, count)
    moment = _blocks(xx, xy, xy, yy)
    return Operators(gradient, model.hourglass * (laplacian - gradient.T @ (moment @ gradient)))


def tangent(model: Model, found: Operators, gradient: np.ndarray) -> sparse.csc_array:
    """K [2N, 2N] (Pa) at the deformation gradients F [4, N]; the x freedoms before the y freedoms."""
    stiffness = model.volume * constitutive.tangent(model.law, gradient)
    transposed = found.gradient.T.tocsr()

    def block(a: int, c: int) -> sparse.csr_array:
        moduli = _blocks(*(stiffness[a, b, c, d] for b in range(2) for d in range(2)))
        return transposed @ (moduli @ found.gradient)

    xx, xy, yy = block(0, 0), block(0, 1), block(1, 1)
    if found.hourglass is not None:
        xx, yy = xx + found.hourglass, yy + found.hourglass
    return sparse.block_array([[xx, xy], [xy.T, yy]], format="csc")


def _square(
    rows: np.ndarray, columns: np.ndarray, values: np.ndarray, diagonal: np.ndarray
) -> sparse.csr_array:
    count = diagonal.size
    all_rows = np.concatenate((rows, np.arange(count)))
    all_columns = np.concatenate((columns, np.arange(count)))
    entries = np.concatenate((values, diagonal))
    return sparse.coo_array((entries, (all_rows, all_columns)), shape=(count, count)).tocsr()


def _blocks(xx: np.ndarray, xy: np.ndarray, yx: np.ndarray, yy: np.ndarray) -> sparse.csr_array:
    """Four diagonal matrices as one of twice the size."""
    return sparse.block_array(
        [
            [sparse.diags_array(xx), sparse.diags_array(xy)],
            [sparse.diags_array(yx), sparse.diags_array(yy)],
        ],
        format="csr",
    )
