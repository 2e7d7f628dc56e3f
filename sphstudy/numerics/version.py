"""The version of the numerics: a number, and digests of the modules that can change a bit of a result.

`version.toml` keeps the number and, for each module of the package that takes part in the numbers of a
run, a digest of its code: docstrings, comments and the places that names are imported from apart. A test
fails when a digest is not today's. Whoever changed the module then either shows that results kept their
bits (`sphstudy compare before.nc after.nc tolerance=0` of study `small`) and types

    python -m sphstudy.numerics.version          digests anew, the number stays: stored runs stay valid

or raises the number, after which all stored runs are stale:

    python -m sphstudy.numerics.version --raise
"""

import ast
import hashlib
import sys
import tomllib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parent.parent
RECORD = Path(__file__).with_name("version.toml")
ROOMS = ("model", "numerics")
"""Folders of the package whose modules take part in the numbers of a run."""

_DIGITS = 12


def version(own: Iterable[Path] = ()) -> str:
    """Version of the numerics of a run.

    Parameters
    ----------
    own : iterable of Path
        Modules that the run uses beside the package's common ones (its scene, its method). Those that
        the record does not list, because a user wrote them, count by their content.

    Returns
    -------
    str
        The number; followed by a digest if the package's sources are not those that the number was given
        to, or if the run uses modules of a user.
    """
    digests = [*_changed(), *(code_digest(path) for path in own if _name(path) not in _recorded()[1])]
    number = str(_recorded()[0])
    return f"{number}+{_digest(sorted(digests))}" if digests else number


@cache
def code_digest(path: Path) -> str:
    """Digest of the code of a module.

    Parameters
    ----------
    path : Path
        A Python file.

    Returns
    -------
    str
        Hexadecimal digits: the same for the same code under Python 3.11 to 3.13, whatever its docstrings
        and comments say and wherever in the package the names lie that it imports.

    Raises
    ------
    SyntaxError
        If the file is not Python.
    """
    source = path.read_text(encoding="utf-8")
    lines = source.splitlines()
    for node in ast.walk(ast.parse(source)):
        if _is_text(node):
            replacement = ""
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("sphstudy"):
            replacement = " ".join(f"import {a.name} as {a.asname}" for a in node.names)
        else:
            continue
        assert isinstance(node, ast.stmt)
        assert node.end_lineno is not None
        lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
        lines[node.lineno - 1] = replacement
    code = (" ".join(line.split()) for line in lines)
    return _digest(line for line in code if line and not line.startswith("#"))


def sources() -> dict[str, Path]:
    """The modules of the package that take part in the numbers of a run, by their name below it."""
    found = (path for room in ROOMS for path in (PACKAGE / room).rglob("*.py"))
    return {_name(path): path for path in sorted(found) if path != Path(__file__)}


def differing() -> list[str]:
    """Names of modules that are not as `version.toml` has them: changed, new, or gone."""
    recorded, found = _recorded()[1], sources()
    return sorted(
        name
        for name in recorded.keys() | found.keys()
        if name not in found or recorded.get(name) != code_digest(found[name])
    )


def _changed() -> list[str]:
    """What today's code of the recorded modules has that the recorded one had not."""
    recorded, found = _recorded()[1], sources()
    return [
        code_digest(found[name]) if name in found else f"without {name}"
        for name in differing()
        if name in recorded
    ]


def _name(path: Path) -> str:
    try:
        return path.relative_to(PACKAGE).with_suffix("").as_posix()
    except ValueError:
        return str(path)


def _is_text(node: ast.AST) -> bool:
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


def _digest(parts: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:_DIGITS]


@cache
def _recorded() -> tuple[int, dict[str, str]]:
    found = tomllib.loads(RECORD.read_text(encoding="utf-8"))
    return found["number"], found["modules"]


def _record(number: int) -> None:
    rows = (f'"{name}" = "{code_digest(path)}"' for name, path in sources().items())
    RECORD.write_text(
        "# Written by `python -m sphstudy.numerics.version`, whose docstring says when.\n"
        f"number = {number}\n\n[modules]\n" + "\n".join(rows) + "\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    told = _recorded()[0] if RECORD.exists() else 0
    _record(told + 1 if "--raise" in sys.argv[1:] or not told else told)
