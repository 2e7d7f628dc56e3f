"""The house: arrows between modules go down only, no two folders import each other, no module is long."""

import ast
from functools import cache
from pathlib import Path

import sphstudy

PACKAGE = Path(sphstudy.__file__).parent

FLOORS = [
    {"errors", "text", "table", "parameters", "console", "catalogue"},
    {"model"},
    {"configuration", "numerics"},
    {"metrics"},
    {"store"},
    {"analysis"},
    {"running", "report"},
    {"benchmarks"},
    {"commands", "api"},
    {"__init__"},
    {"__main__"},
]
"""Rooms from the ground up. Rooms of one floor do not see each other; the ground floor's files do."""

LONGEST = 300
"""Lines of a module."""


@cache
def imports() -> dict[str, set[str]]:
    """For each module of the package, by its name below it, the modules that it imports."""
    files = {path.relative_to(PACKAGE).with_suffix("").as_posix(): path for path in PACKAGE.rglob("*.py")}

    def named(dotted: str) -> str | None:
        below = dotted.replace(".", "/").removeprefix("sphstudy").removeprefix("/")
        return next((n for n in (below, f"{below}/__init__".lstrip("/")) if n in files), None)

    def targets(node: ast.AST) -> list[str | None]:
        if isinstance(node, ast.Import):
            return [named(a.name) for a in node.names if a.name.split(".")[0] == "sphstudy"]
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "sphstudy":
            return [named(f"{node.module}.{a.name}") or named(str(node.module)) for a in node.names]
        return []

    return {
        name: {t for node in ast.walk(ast.parse(path.read_text())) for t in targets(node) if t}
        for name, path in files.items()
    }


def arrows() -> set[tuple[str, str]]:
    return {(a, b) for a, several in imports().items() for b in several if a != b}


def floor(module: str) -> int:
    return next(k for k, rooms in enumerate(FLOORS) if module.split("/")[0] in rooms)


def upward() -> set[str]:
    return {
        f"{a} -> {b}"
        for a, b in arrows()
        if a.split("/")[0] != b.split("/")[0] and floor(a) <= floor(b) and floor(b) > 0
    }


def folders_that_import_each_other() -> set[str]:
    folder = lambda module: module.rpartition("/")[0] or module  # noqa: E731
    pairs = {(folder(a), folder(b)) for a, b in arrows() if folder(a) != folder(b)}
    return {f"{a} <-> {b}" for a, b in pairs if a < b and (b, a) in pairs}


def circles() -> set[str]:
    """Modules that import themselves by way of others."""
    left = dict(imports())
    while free := [name for name, several in left.items() if not several & left.keys() - {name}]:
        for name in free:
            del left[name]
    while free := {name for name in left if not any(name in left[o] for o in left if o != name)}:
        left = {name: several for name, several in left.items() if name not in free}
    return {f"circle through {name}" for name in left}


def long_modules() -> set[str]:
    lengths = {path: len(path.read_text().splitlines()) for path in PACKAGE.rglob("*.py")}
    return {f"{p.relative_to(PACKAGE)} is long" for p, lines in lengths.items() if lines > LONGEST}


def test_the_house_stands():
    found = upward() | folders_that_import_each_other() | circles() | long_modules()
    assert sorted(found) == []
