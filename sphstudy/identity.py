"""What a record's name rests on: the parameters of the run and the version of its numerics.

Both versions, of numerics and of metrics, are derived from the sources: the code of the modules
concerned and of everything in the package that they import, without docstrings and comments. What a
scene wants measured and shown belongs to neither: it changes no number.
"""

import ast
import hashlib
import json
from functools import cache, lru_cache
from pathlib import Path

from sphstudy.config import RunConfig, scene_module

_PACKAGE = Path(__file__).parent
_LISTS = {"METRICS", "HEADLINE"}


def numerics_version(config: RunConfig) -> str:
    """Version of scene, method and solver: if it changes, the numbers of a run may change."""
    return _version(
        (
            f"scenes.{config.scene.kind}",
            f"methods.{config.method.kind}",
            f"solve.{config.solve.name}",
        )
    )


def metrics_version(config: RunConfig) -> str:
    """Version of the scene's metrics and of what they read from records: if it changes, they are measured
    again from the fields.
    """
    names = scene_module(config.scene.kind).METRICS
    return _version(tuple(f"metrics.{name}" for name in names))


def key(config: RunConfig) -> str:
    """Hash of everything that determines the numbers of a run, 16 hexadecimal digits."""
    return _key(config.text, numerics_version(config))


@lru_cache(maxsize=100_000)
def _key(configuration: str, version: str) -> str:
    text = f"[{configuration}, {json.dumps(version)}]"
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@lru_cache
def _version(modules: tuple[str, ...]) -> str:
    digest = hashlib.sha256()
    for path in sorted(_closure(modules)):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode())
        digest.update(_code(path).encode())
    return digest.hexdigest()[:12]


def _closure(modules: tuple[str, ...]) -> set[Path]:
    """Files of the modules and of all modules of the package that they import, and so on."""
    found: set[Path] = set()
    waiting = [path for name in modules if (path := _path(name))]
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        found.add(path)
        waiting += _imported(path)
    return found


@cache
def _imported(path: Path) -> list[Path]:
    found: list[Path] = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and (module := node.module or "").startswith("sphstudy"):
            parent = module.removeprefix("sphstudy").lstrip(".")
            names = [parent, *(f"{parent}.{alias.name}".lstrip(".") for alias in node.names)]
            found += [p for name in names if (p := _path(name))]
    return found


def _path(module: str) -> Path | None:
    path = _PACKAGE.joinpath(*module.split(".")).with_suffix(".py")
    return path if path.is_file() else None


@cache
def _code(path: Path) -> str:
    tree = ast.parse(path.read_text())
    for node in ast.walk(tree):
        if isinstance(body := getattr(node, "body", None), list):
            body[:] = [s for s in body if not (_is_text(s) or _is_list(s))]
    return ast.unparse(tree)


def _is_text(statement: ast.AST) -> bool:
    return (
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Constant)
        and isinstance(statement.value.value, str)
    )


def _is_list(statement: ast.AST) -> bool:
    """Whether a scene lists here what it wants measured or shown."""
    return isinstance(statement, ast.Assign) and any(
        isinstance(target, ast.Name) and target.id in _LISTS for target in statement.targets
    )
