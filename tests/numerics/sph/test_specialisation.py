"""A term that a scene does not use is neither in the generated code nor in memory."""

import re

import numpy as np
import pytest

from sphstudy.model.material import Material
from sphstudy.numerics.sph import bond_sums, constitutive, pair_sums
from sphstudy.numerics.sph.updated_lagrangian import build_neighbours, rates, workspace
from tests.numerics.sph.clouds import lattice_positions, model, random_state

pytestmark = pytest.mark.compiled


def generated(rng, terms):
    """Assembly of the momentum terms of a model with these terms, compiled afresh."""
    positions = lattice_positions()
    made, state = model(rng, positions, terms), random_state(rng, positions)
    pairs, work = build_neighbours(made, state), workspace(made, positions.shape[1])
    rates(made, state, pairs, 0.0, work, np.zeros_like(state))
    kernel = pair_sums._momentum_terms.py_func
    import numba

    fresh = numba.njit(error_model="numpy")(kernel)
    zero, count = np.int64(0), np.int64(8)
    fresh(made, work.pair_data, zero, count, count, work.terms[0])
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


def generated_from(function, *arguments):
    """LLVM code of a compiled function for these arguments, compiled afresh."""
    import numba

    fresh = numba.njit(error_model="numpy")(function.py_func)
    fresh(*arguments)
    return fresh.inspect_llvm(fresh.signatures[0])


def test_a_law_is_compiled_without_the_others():
    material = Material(10.0, 0.3, 1.0, "strain")
    code = {
        name: generated_from(constitutive.stress, constitutive.law(name, material), 1.1, 0.1, 0.0, 0.9)
        for name in constitutive.LAWS
    }
    products = {name: operations(text, "fmul[a-z ]*") for name, text in code.items()}
    assert products["linear"] < products["svk"]
    assert "log" in code["neohookean"]
    assert "log" not in code["linear"] + code["svk"]


def test_loops_over_bonds_are_vectorised():
    values, one = np.zeros((4, 64)), 1.0
    x, y = values[0], values[1]
    there, sums, terms = np.ones(32, np.uint8), np.zeros((4, 64)), np.zeros((2, 64))
    moments = generated_from(bond_sums._add_moments, x, y, 0, 3, 32, there, one, one, 0, sums)
    for hourglass in (one, None):
        force = generated_from(
            bond_sums._force_terms, x, y, values, 0, 3, 32, there, one, one, one, hourglass, terms
        )
        for code in (moments, force):
            assert re.search(r"fmul[a-z ]*<\d+ x double>", code)


def test_without_hourglass_energy_its_force_is_not_compiled():
    values, one = np.zeros((4, 64)), 1.0
    there, terms = np.ones(32, np.uint8), np.zeros((2, 64))
    code = {
        hourglass: generated_from(
            bond_sums._force_terms, *values[:2], values, 0, 3, 32, there, one, one, one, hourglass, terms
        )
        for hourglass in (one, None)
    }
    assert operations(code[None], "fsub[a-z ]*<\\d+ x double>") == 0
    assert operations(code[one], "fsub[a-z ]*<\\d+ x double>") > 0
