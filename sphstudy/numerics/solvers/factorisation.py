"""Stiffness matrices, factorised once and solved with often: banded Cholesky (LAPACK).

The stencil of a stiffness is wide, two supports to each side, so that a sparse factorisation fills up
with dense blocks anyway. Freedoms in order along the body give a band no wider than that stencil times
the body's breadth: a square of 120² particles takes a quarter of the time that SuperLU takes, a slender
plate far less.
"""

import numpy as np
import scipy.sparse as sparse
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded
from threadpoolctl import threadpool_limits

SMALLEST_PIVOT = 1e-13
"""Of the largest: below, the matrix is singular to rounding."""


class NotSolvable(ArithmeticError):
    """A system that has no solution worth the name; the message says why."""


def along_body(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Order [N] of particles at x, y [N] (m) along the body's longer side, lines across it together.

    Coordinates that differ by rounding only count as the same.
    """
    extent_x, extent_y = np.ptp(x), np.ptp(y)
    longer, other = (x, y) if extent_x >= extent_y else (y, x)
    return np.lexsort((other, np.round(longer / (1e-9 * max(extent_x, extent_y)))))


class Factorisation:
    """L Lᵀ of a symmetric matrix [M, M] whose rows in this `order` [M] make a narrow band.

    entries: of L. Raises NotSolvable if the matrix is not positive definite, or singular to rounding.
    """

    def __init__(self, matrix: sparse.csc_array, order: np.ndarray):
        self._order = order
        band = _lower_band(matrix, order)
        self.entries = band.size
        try:
            # Threads of BLAS wait for each other by spinning: two on a busy machine cost fifty times one.
            with threadpool_limits(1, user_api="blas"):
                self._factor = cholesky_banded(band, overwrite_ab=True, lower=True, check_finite=False)
        except LinAlgError:
            raise NotSolvable(
                "the stiffness is not positive definite: an unstable state, or modes without energy"
            ) from None
        pivots = self._factor[0] ** 2
        if not pivots.min() > SMALLEST_PIVOT * pivots.max():
            ratio = pivots.min() / pivots.max()
            raise NotSolvable(f"the stiffness is singular: pivots down to {ratio:.1e} of the largest")

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution [M] for the right-hand side [M]."""
        found = np.empty_like(right)
        with threadpool_limits(1, user_api="blas"):
            found[self._order] = cho_solve_banded(
                (self._factor, True), right[self._order], overwrite_b=True, check_finite=False
            )
        return found


def _lower_band(matrix: sparse.csc_array, order: np.ndarray) -> np.ndarray:
    """The matrix in this order as LAPACK has lower bands: [width + 1, M]."""
    rank = np.empty_like(order)
    rank[order] = np.arange(order.size)
    entries = matrix.tocoo()
    row, column = rank[entries.row], rank[entries.col]
    lower = row >= column
    row, column, values = row[lower], column[lower], entries.data[lower]
    band = np.zeros((int((row - column).max(initial=0)) + 1, order.size), order="F")
    band[row - column, column] = values
    return band
