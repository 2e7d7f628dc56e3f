"""What a record's name rests on: the parameters of the run and the version of its numerics.

The version of the numerics is a number that people raise (`numerics/version.py`); that of the metrics is
a digest of the code of the modules that a scene lists and of the other metrics that these import.
"""

import ast
import hashlib
import json
from functools import cache, lru_cache
from pathlib import Path

from sphstudy import catalogue
from sphstudy.catalogue import method_module, scene_module, solver_module
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.numerics.version import PACKAGE, code_digest, version

_MEASURING = ("metrics", "model/exact")
"""Folders of the package whose code makes metrics of fields."""


def numerics_version(config: RunConfig) -> str:
    """Version of the numerics of a run: if it changes, its numbers may change.

    Parameters
    ----------
    config : RunConfig
        The run.

    Returns
    -------
    str
        The package's number; with a digest behind it where the run uses other code.
    """
    return _version(config.scene.kind, config.method.kind, config.solve.name)


@cache
def _version(scene: str, method: str, solver: str) -> str:
    modules = scene_module(scene), method_module(method), solver_module(solver)
    return version(Path(module.__file__) for module in modules if module.__file__)


def metrics_version(config: RunConfig) -> str:
    """Version of the metrics of a scene: if it changes, they are measured again from the fields.

    Parameters
    ----------
    config : RunConfig
        The run.

    Returns
    -------
    str
        Hexadecimal digits.
    """
    return _metrics_version(catalogue.metrics(config.scene.name))


@cache
def _metrics_version(names: tuple[str, ...]) -> str:
    waiting = [PACKAGE / "metrics" / f"{name}.py" for name in names]
    found: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += _measuring(path)
    digests = sorted(code_digest(path) for path in found)
    return hashlib.sha256(" ".join(digests).encode()).hexdigest()[:12]


def _measuring(path: Path) -> list[Path]:
    """Modules of metrics and of exact answers that a module imports."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("sphstudy."):
            below = str(node.module).split(".")[1:]
            names = [below, *([*below, alias.name] for alias in node.names)]
            found += [PACKAGE.joinpath(*name).with_suffix(".py") for name in names]
    folders = [PACKAGE / folder for folder in _MEASURING]
    return [path for path in found if path.parent in folders and path.is_file()]


def key(config: RunConfig) -> str:
    """Hash of everything that determines the numbers of a run.

    Parameters
    ----------
    config : RunConfig
        The run.

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    return _key(config.text, numerics_version(config))


@lru_cache(maxsize=100_000)
def _key(configuration: str, version: str) -> str:
    text = f"[{configuration}, {json.dumps(version)}]"
    return hashlib.sha256(text.encode()).hexdigest()[:16]
