"""A term that a scene does not use is neither in the generated code nor in memory."""

import re

import numpy as np
import pytest

from sphstudy.sph import pair_sums
from sphstudy.sph.updated_lagrangian import build_neighbours, rates, workspace
from tests.sph.clouds import lattice_positions, model, random_state

pytestmark = pytest.mark.compiled


def generated(rng, terms):
    """Assembly of the momentum terms of a model with these terms, compiled afresh."""
    positions = lattice_positions()
    made, state = model(rng, positions, terms), random_state(rng, positions)
    pairs, work = build_neighbours(made, state), workspace(made, positions.shape[1])
    rates(made, state, pairs, 0.0, work, np.zeros_like(state))
    kernel = pair_sums._momentum_terms.py_func
    import numba

    from sphstudy.compilation import _FAST_MATH

    fresh = numba.njit(fastmath=_FAST_MATH, error_model="numpy")(kernel)
    zero, count = np.int64(0), np.int64(8)
    fresh(made, work.pair_data, zero, count, count, work.terms)
    return fresh.inspect_llvm(fresh.signatures[0])


def operations(code, name):
    return len(re.findall(rf"= {name} ", code))


def test_absent_terms_leave_no_arithmetic(rng):
    bare = generated(rng, ())
    viscous = generated(rng, ("viscosity",))
    artificial = generated(rng, ("artificial",))
    assert operations(viscous, "fdiv[a-z ]*") > operations(bare, "fdiv[a-z ]*")
    assert operations(viscous, "fmul[a-z ]*") > operations(bare, "fmul[a-z ]*")
    assert operations(artificial, "fmul[a-z ]*") > operations(bare, "fmul[a-z ]*")


def test_pair_loop_is_vectorised(rng):
    code = generated(rng, ("viscosity", "artificial"))
    assert re.search(r"fmul[a-z ]*<\d+ x double>", code)


@pytest.mark.parametrize(
    ("terms", "rows"),
    [((), 10), (("viscosity",), 11), (("artificial",), 13), (("viscosity", "artificial"), 14)],
)
def test_absent_terms_have_no_arrays(rng, terms, rows):
    positions = lattice_positions()
    assert workspace(model(rng, positions, terms), 72).pair_data.shape == (rows, 72)


def test_no_crack_no_visibility(rng):
    positions = lattice_positions()
    assert model(rng, positions, ()).crack is None
