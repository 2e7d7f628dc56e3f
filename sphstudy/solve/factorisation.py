"""Sparse symmetric matrices, factorised once and solved with often."""

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

SMALLEST_PIVOT = 1e-13
"""Of the largest: below, the matrix is singular to rounding."""


class NotSolvable(ArithmeticError):
    """A system that has no solution worth the name; the message says why."""


class Factorisation:
    """L D Lᵀ of a symmetric matrix [M, M], pivots on the diagonal.

    entries: of L and U. negative: how many eigenvalues are negative, if `judge` asks for it (Sylvester:
    as many as pivots), else 0. Raises NotSolvable if the matrix is singular to rounding.
    """

    def __init__(self, matrix: sparse.csc_array, judge: bool = True):
        try:
            # Minimum degree on A + Aᵀ: COLAMD, the default, takes three times as long. Wider panels and
            # supernodes would save a third, but SuperLU writes beyond its work space with them.
            self._factors = scipy.sparse.linalg.splu(
                sparse.csc_matrix(matrix),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError:
            raise NotSolvable("the stiffness is singular") from None
        self.entries, self.negative = int(self._factors.nnz), 0
        if judge:
            pivots = self._factors.U.diagonal()
            size = np.abs(pivots)
            if not size.min() > SMALLEST_PIVOT * size.max():
                ratio = size.min() / size.max()
                raise NotSolvable(f"the stiffness is singular (pivots differ by a factor {ratio:.1e})")
            self.negative = int(np.count_nonzero(pivots < 0.0))

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution [M] for the right-hand side [M]."""
        return self._factors.solve(right)
