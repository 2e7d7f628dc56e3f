"""The key of a run: what changes it and what does not."""

import textwrap

import pytest

from sphstudy import identity
from sphstudy.composition import session


@pytest.fixture(scope="module")
def config_of():
    with session() as hydra:
        yield lambda *overrides: hydra.points(list(overrides), sweep=False)[0][0].config


def test_everything_that_determines_the_numbers_changes_the_key(config_of):
    variants = [
        (),
        ("h=1.6",),
        ("n=50",),
        ("scene=mode2",),
        ("scene.nu=0.31",),
        ("method.skin=0.2",),
        ("solve.settle_steps=4001",),
        ("record.samples=500",),
        ("record.times=[0.5]",),
        ("seed=1",),
    ]
    keys = [identity.key(config_of(*overrides)) for overrides in variants]
    assert len(set(keys)) == len(variants)


def test_where_it_is_stored_and_how_it_is_written_do_not(config_of):
    key = identity.key(config_of())
    assert identity.key(config_of("results=elsewhere")) == key
    assert identity.key(config_of("h=1.50", "scene.E=6.0e6")) == key
    assert identity.key(config_of("h=1.5000000000000002")) == key


def test_versions_cover_what_is_imported_and_nothing_else(config_of):
    modules = ("scenes.plate", "methods.updated_lagrangian", "solve.explicit")
    files = {path.name for path in identity._closure(modules)}
    assert {"plate.py", "problem.py", "beam.py", "explicit.py", "heun.py", "pair_sums.py"} <= files
    assert not {"williams.py", "fracture.py", "collect.py", "total_lagrangian.py", "newton.py"} & files
    assert identity.numerics_version(config_of("scene=plate")) != identity.numerics_version(config_of())


def test_versions_ignore_comments_docstrings_and_what_is_measured_but_not_code(tmp_path):
    before = tmp_path / "before.py"
    before.write_text('"""Doc."""\nMETRICS = ("one",)\ndef f(x):\n    """More."""\n    return x + 1\n')
    same = tmp_path / "same.py"
    same.write_text(
        textwrap.dedent('''
        # a comment
        def f(x):
            """Other words."""
            return x + 1  # and why
        ''')
    )
    other = tmp_path / "other.py"
    other.write_text("def f(x):\n    return x + 2\n")
    assert identity._code(before) == identity._code(same) != identity._code(other)
