"""Where everything that is found by name lies: settings, studies, references, scenes, methods, metrics.

A scene is `model/scenes/<kind>.py`, a method `numerics/methods/<kind>.py`, a solver
`numerics/solvers/<name>.py`, a module of metrics `metrics/<name>.py`: nothing is registered.
"""

import importlib
from functools import cache
from pathlib import Path
from types import ModuleType

from sphstudy.errors import ConfigurationError

_PACKAGE = Path(__file__).parent
_PLUG_INS = {
    "scenes": "model.scenes",
    "methods": "numerics.methods",
    "solvers": "numerics.solvers",
    "metrics": "metrics",
}


def _lies(name: str) -> Path:
    inside = _PACKAGE / name
    beside = _PACKAGE.parent / ("results" if name == "reference" else "") / name
    return inside if inside.is_dir() else beside


FOLDERS = {name: _lies(name) for name in ("conf", "studies", "reference")}
"""Folders of data: in the package when installed; in a checkout beside it, references in `results`."""


def folder(name: str) -> Path:
    """One of FOLDERS.

    Parameters
    ----------
    name : {"conf", "studies", "reference"}
        Settings, studies, or stored references.
    """
    return FOLDERS[name]


def module(group: str, name: str) -> ModuleType:
    """The module of a plug-in.

    Parameters
    ----------
    group : {"scenes", "methods", "solvers", "metrics"}
        What it is.
    name : str
        The kind of a scene or method, the name of a solver or of a module of metrics.

    Raises
    ------
    ConfigurationError
        If there is none of that name.
    """
    return _module(group, name)


@cache
def _module(group: str, name: str) -> ModuleType:
    if not (isinstance(name, str) and name.isidentifier()):
        raise ConfigurationError([f"{group}: {name!r} is not the name of a module"])
    try:
        found = importlib.import_module(f"sphstudy.{_PLUG_INS[group]}.{name}")
    except ModuleNotFoundError as error:
        raise ConfigurationError([f"{group}: there is no module {name!r} ({error})"]) from None
    if group != "metrics" and not hasattr(found, "Parameters"):
        raise ConfigurationError([f"{group}: module {name!r} has no Parameters"])
    return found


def scene_module(kind: str) -> ModuleType:
    """The module that builds scenes of this kind."""
    return module("scenes", kind)


def method_module(kind: str) -> ModuleType:
    """The module of methods of this kind."""
    return module("methods", kind)


def solver_module(name: str) -> ModuleType:
    """The module of a solver."""
    return module("solvers", name)


def headline(scene: str, solver: str) -> tuple[str, ...]:
    """What tables show of a run first: the scene's metrics, or numbers of a solver that has none of them.

    scene: kind of scene; solver: its name.
    """
    return getattr(solver_module(solver), "HEADLINE", scene_module(scene).HEADLINE)
