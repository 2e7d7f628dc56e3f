"""The version of the numerics: what moves its digests, and what a user's own module does to it."""

import pytest

from sphstudy.numerics import version

BEFORE = '''"""Doc."""
from sphstudy.sph import kernel

def f(x):
    """More."""
    return kernel.value(x) + 1
'''

SAME = '''
# a comment
from sphstudy.elsewhere.altogether import kernel


def f(x):
    """Other words.

    And more of them.
    """
    # why
    return kernel.value(x) + 1
'''


@pytest.fixture
def module(tmp_path):
    count = iter(range(100))

    def written(text):
        path = tmp_path / f"m{next(count)}.py"
        path.write_text(text, encoding="utf-8")
        return path

    return written


@pytest.fixture
def recorded(tmp_path, monkeypatch):
    """A package of two modules, recorded with the number 7."""
    (tmp_path / "sph").mkdir()
    for name in ("kernel", "bonds"):
        (tmp_path / "sph" / f"{name}.py").write_text(f"NAME = {name!r}\n")
    monkeypatch.setattr(version, "PACKAGE", tmp_path)
    monkeypatch.setattr(version, "ROOMS", ("sph",))
    monkeypatch.setattr(version, "RECORD", tmp_path / "version.toml")
    forget()
    version._record(7)
    yield tmp_path
    forget()


def forget():
    version._recorded.cache_clear()
    version.code_digest.cache_clear()


def test_the_number_belongs_to_the_sources_as_they_are():
    assert version.differing() == [], (
        "the code of these modules is not what the version of the numerics was given to: show that "
        "results kept their bits, or raise the number (sphstudy/numerics/version.py says how)"
    )


def test_docstrings_comments_and_places_of_names_move_no_digest(module):
    assert version.code_digest(module(BEFORE)) == version.code_digest(module(SAME))


@pytest.mark.parametrize(
    ("was", "becomes"),
    [("+ 1", "+ 2"), ("import kernel", "import other as kernel"), ("def f(x)", "def f(x, y)")],
)
def test_code_moves_it(module, was, becomes):
    assert was in BEFORE
    assert version.code_digest(module(BEFORE)) != version.code_digest(
        module(BEFORE.replace(was, becomes))
    )


def test_a_changed_module_is_named_and_seen_in_every_version(recorded):
    assert version.version() == "7"
    (recorded / "sph" / "kernel.py").write_text("NAME = 'another'\n")
    forget()
    assert version.differing() == ["sph/kernel"]
    first = version.version()
    assert first.startswith("7+")
    (recorded / "sph" / "kernel.py").write_text("NAME = 'a third'\n")
    forget()
    assert version.version() != first


def test_a_module_that_is_gone_is_seen_too(recorded):
    (recorded / "sph" / "bonds.py").unlink()
    forget()
    assert version.differing() == ["sph/bonds"]
    assert version.version().startswith("7+")


def test_a_new_module_counts_for_the_runs_that_use_it_and_for_no_others(recorded, module):
    (recorded / "sph" / "own.py").write_text("NAME = 'own'\n")
    forget()
    assert version.differing() == ["sph/own"]
    assert version.version() == "7"
    assert version.version([recorded / "sph" / "kernel.py"]) == "7"
    inside, outside = version.version([recorded / "sph" / "own.py"]), version.version([module("X = 1\n")])
    assert inside.startswith("7+")
    assert outside.startswith("7+")
    assert inside != outside


def test_recording_keeps_the_number(recorded):
    (recorded / "sph" / "kernel.py").write_text("NAME = 'another'\n")
    forget()
    version._record(7)
    forget()
    assert (version.differing(), version.version()) == ([], "7")
