"""Where everything that is found by name lies: settings, studies, references, scenes, methods, metrics.

A scene is `model/scenes/<kind>.py`, a method `numerics/methods/<kind>.py`, a solver
`numerics/solvers/<name>.py`, a module of metrics `metrics/<name>.py`: nothing is registered. Settings are
`<group>/<name>.yaml` in a folder of the user's, or in `conf`.
"""

import importlib
import os
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import yaml

from sphstudy.errors import ConfigurationError, unknown

_PACKAGE = Path(__file__).parent
_PLUG_INS = {
    "scenes": "model.scenes",
    "methods": "numerics.methods",
    "solvers": "numerics.solvers",
    "metrics": "metrics",
}
_OWN = "SPHSTUDY_CONFIG_DIR"


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


def settings_folders() -> list[Path]:
    """Folders of settings, the first that has a file counts: the user's own, then the package's."""
    own = os.environ.get(_OWN, "")
    return [*(Path(place) for place in own.split(os.pathsep) if place), folder("conf")]


def add_settings(place: str | Path) -> None:
    """Looks for settings in a folder of the user's, from now on, before all others.

    The folder is kept in the environment variable SPHSTUDY_CONFIG_DIR, which the workers of this process
    inherit: they ask for the metrics of a scene too.

    Parameters
    ----------
    place : str or Path
        A folder with `scene`, `method`, … in it, as `conf`.

    Raises
    ------
    ConfigurationError
        If there is no such folder.
    """
    found = Path(place).resolve()
    if not found.is_dir():
        raise ConfigurationError([f"{place}: there is no such folder of settings"])
    if found not in settings_folders():
        os.environ[_OWN] = os.pathsep.join(filter(None, (str(found), os.environ.get(_OWN))))


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


def names(group: str) -> list[str]:
    """Names of all settings of a group ("scene", "method", "solve"), in order."""
    return sorted({path.stem for place in settings_folders() for path in (place / group).glob("*.yaml")})


def settings(group: str, name: str) -> dict[str, Any]:
    """A file of settings, with those that it inherits by `defaults: [parent, _self_]`.

    Parameters
    ----------
    group : {"scene", "method", "solve"}
        Folder of the file.
    name : str
        Name of the file.

    Returns
    -------
    dict
        Nested settings, which callers must not change, the name of the file among them. A quantity's
        bound replaces the parent's as a whole.

    Raises
    ------
    ConfigurationError
        If there is no such file, or if it is not a mapping in YAML.
    """
    return _settings(group, name, tuple(settings_folders()))


@cache
def _settings(
    group: str, name: str, folders: tuple[Path, ...], heirs: tuple[str, ...] = ()
) -> dict[str, Any]:
    path = next((p for place in folders if (p := place / group / f"{name}.yaml").is_file()), None)
    if path is None:
        raise ConfigurationError([unknown(group, name, names(group))])
    own = read(path)
    inherited = own.pop("defaults", ["_self_"])
    found: dict[str, Any] = {}
    for parent in inherited if isinstance(inherited, list) else [inherited]:
        if not isinstance(parent, str) or "/" in parent or parent in (name, *heirs):
            raise ConfigurationError([f"{group}/{path.name}: defaults: {parent} is no name of a {group}"])
        above = own if parent == "_self_" else _settings(group, parent, folders, (name, *heirs))
        both = [part["bounds"] for part in (found, above) if isinstance(part.get("bounds"), dict)]
        found = merged(found, above)
        if len(both) == 2:
            found["bounds"] = both[0] | both[1]
    # A scene's file speaks of other parts of the configuration too: its own are below `scene`.
    return merged(found, {group: {"name": name}} if group in found else {"name": name})


def read(path: Path) -> dict[str, Any]:
    """A file of settings as it stands.

    Parameters
    ----------
    path : Path
        A YAML file.

    Raises
    ------
    ConfigurationError
        If it is not a mapping in YAML; names its folder and the file.
    """
    place = f"{path.parent.name}/{path.name}"
    try:
        found = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError) as error:
        raise ConfigurationError([f"{place}: {' '.join(str(error).split())}"]) from None
    if not isinstance(found, dict):
        raise ConfigurationError([f"{place}: should be a mapping (dictionary) of settings by name"])
    return found


def merged(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Nested settings, those `above` in place of those `below`; only mappings are merged."""
    both = below | above
    for key, inner in below.items():
        if isinstance(inner, dict) and isinstance(above.get(key), dict):
            both[key] = merged(inner, above[key])
    return both


def metrics(scene: str) -> tuple[str, ...]:
    """Modules of metrics that measure a scene, by its name. Raises ConfigurationError as `settings`."""
    return tuple(_list(scene, "metrics"))


def headline(scene: str, solver: str) -> tuple[str, ...]:
    """Metrics that tables show of a run: the scene's, or those of a solver that records no motion.

    Parameters
    ----------
    scene, solver : str
        Their names.

    Raises
    ------
    ConfigurationError
        As `settings`.
    """
    own = getattr(solver_module(solver), "HEADLINE", None)
    return tuple(own or _list(scene, "headline"))


def _list(scene: str, section: str) -> list[str]:
    found = settings("scene", scene).get(section)
    if not (isinstance(found, list) and all(isinstance(name, str) for name in found)):
        raise ConfigurationError([f"scene/{scene}.yaml: {section}: should be a list of names"])
    return found


def protocol(scene: str, method: str, solver: str) -> dict[str, Any]:
    """Settings that a scene asks for when a method and a solver are chosen, by part of the configuration.

    The scene's file has them in `protocol: {method: {solver: …}}`. So that an own method needs no other
    file, the method's may have them too, in `protocol: {scene: {solver: …}}`, and these win.

    Parameters
    ----------
    scene, method, solver : str
        Their names.

    Raises
    ------
    ConfigurationError
        As `settings`, and if a protocol is not made of mappings.
    """
    found: dict[str, Any] = {}
    for group, name, keys in (("scene", scene, (method, solver)), ("method", method, (scene, solver))):
        part = settings(group, name).get("protocol", {})
        for key in keys:
            part = part.get(key, {}) if isinstance(part, dict) else part
        if not (isinstance(part, dict) and all(isinstance(value, dict) for value in part.values())):
            place = f"{group}/{name}.yaml: protocol.{'.'.join(keys)}"
            raise ConfigurationError(
                [f"{place}: should be settings by part: {{solve: {{…}}, method: …}}"]
            )
        found = merged(found, part)
    return found
