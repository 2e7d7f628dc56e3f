"""Banded Cholesky against dense algebra, and what it says of matrices that cannot be solved with."""

import numpy as np
import pytest
import scipy.sparse as sparse

from sphstudy.numerics.solvers.factorisation import Factorisation, NotSolvable, along_body


def banded(rng, size, width, shift):
    """A random symmetric matrix of that band width, shuffled, and the order that unshuffles it."""
    dense = np.zeros((size, size))
    for k in range(width + 1):
        values = rng.normal(size=size - k)
        dense += np.diag(values, k) + np.diag(values, -k)
    dense += shift * np.eye(size)
    shuffle = rng.permutation(size)
    return sparse.csc_array(dense[np.ix_(shuffle, shuffle)]), np.argsort(shuffle)


def test_solves_what_dense_algebra_solves(rng):
    matrix, order = banded(rng, 60, 4, 30.0)
    right = rng.normal(size=60)
    found = Factorisation(matrix, order)
    np.testing.assert_allclose(found.solve(right), np.linalg.solve(matrix.toarray(), right), rtol=1e-11)
    assert found.entries == 5 * 60


def test_indefinite_matrices_are_refused(rng):
    matrix, order = banded(rng, 30, 2, 0.0)
    assert np.linalg.eigvalsh(matrix.toarray())[0] < 0.0
    with pytest.raises(NotSolvable, match="not positive definite"):
        Factorisation(matrix, order)


def test_singular_matrices_are_refused():
    """A chain that floats, but for rounding: all pivots are positive, the last is as good as zero."""
    diagonal = np.r_[1.0, np.full(18, 2.0), 1.0 + 4e-15]
    chain = sparse.diags_array([-np.ones(19), diagonal, -np.ones(19)], offsets=[-1, 0, 1])
    with pytest.raises(NotSolvable, match="singular: pivots down to"):
        Factorisation(sparse.csc_array(chain), np.arange(20))


def test_order_goes_along_the_longer_side(rng):
    x, y = np.meshgrid(0.1 * np.arange(12), 0.1 * np.arange(4))
    x = x.ravel() + 1e-16 * rng.integers(-3, 4, 48)
    for longer, other in ((x, y.ravel()), (y.ravel(), x)):
        order = along_body(longer, other)
        along, across = (longer, other) if np.ptp(longer) > np.ptp(other) else (other, longer)
        assert np.all(np.diff(along[order]) > -1e-12)
        # Within a line, in order too: neighbours in line are neighbours in the matrix.
        assert np.all(np.diff(across[order].reshape(12, 4), axis=1) > 0.05)
