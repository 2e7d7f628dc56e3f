"""The commands that only look at what the program offers: list, describe."""

from typing import Literal, get_args, get_origin

from pydantic.fields import FieldInfo
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from sphstudy import catalogue
from sphstudy.catalogue import method_module, scene_module, solver_module
from sphstudy.configuration import study_file
from sphstudy.errors import ConfigurationError

_GROUPS = {"scene": scene_module, "method": method_module, "solve": solver_module}
_NAME = 16
"""Width of a column of names."""


def _settings(group: str, name: str) -> dict:
    return catalogue.settings(group, name)


def _names(group: str) -> list[str]:
    return catalogue.names(group)


def _first_line(module) -> str:
    return (module.__doc__ or "").strip().splitlines()[0]


def _module(group: str, name: str):
    settings = _settings(group, name)
    settings = settings.get(group, settings)
    return _GROUPS[group](name if group == "solve" else settings["kind"])


def list_command(arguments: list[str]) -> int:
    """Prints scenes, methods, solvers, metrics and studies."""
    if arguments:
        raise ConfigurationError([f"{' '.join(arguments)}: list takes no arguments"])
    for group in _GROUPS:
        print(f"{group}:")
        for name in _names(group):
            print(f"  {name:{_NAME}s} {_first_line(_module(group, name))}")
    print("metrics:")
    modules = {m: None for name in _names("scene") for m in catalogue.metrics(name)}
    for name in modules:
        module = catalogue.module("metrics", name)
        print(f"  {name:{_NAME}s} {_first_line(module)}")
    print("studies:")
    titles = dict(
        [*((name, study_file.load(name).title) for name in study_file.names()), study_file.SPEED]
    )
    for name in sorted(titles):
        print(f"  {name:{_NAME}s} {titles[name]}")
    return 0


def describe_command(arguments: list[str]) -> int:
    """Prints every setting of a scene, method or solver: value, range, unit, meaning."""
    if len(arguments) == 1:
        owners = [group for group in _GROUPS if arguments[0] in _names(group)]
        arguments = [*owners[:1], *arguments]
    if len(arguments) != 2 or arguments[0] not in _GROUPS:
        raise ConfigurationError(
            [f"describe {' '.join(arguments)}: write describe {'|'.join(_GROUPS)} NAME"]
        )
    group, name = arguments
    settings = _settings(group, name)
    values = settings.get(group, settings)
    module = _module(group, name)
    print(f"{group}={name}: {_first_line(module)}\n")
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("key", "value", "allowed", "meaning"):
        table.add_column(heading, overflow="fold")
    if "n" in settings:
        table.add_row("n", str(settings["n"]), "", (module.Parameters.__doc__ or "").strip())
    for key, field in module.Parameters.__pydantic_fields__.items():
        if key not in ("name", "kind"):
            meaning, allowed = _meaning(field)
            table.add_row(f"{group}.{key}", str(values[key]), allowed, meaning)
    _console().print(table)
    return 0


def _meaning(field: FieldInfo) -> tuple[str, str]:
    """Meaning and allowed values of a setting."""
    kinds = get_args(field.annotation) or (field.annotation,)
    if get_origin(field.annotation) is Literal:
        allowed = " | ".join(str(choice) for choice in kinds)
    else:
        allowed = " and ".join(
            f"{sign} {getattr(limit, bound):g}"
            for limit in field.metadata
            for bound, sign in _SIGNS.items()
            if hasattr(limit, bound)
        )
    if type(None) in kinds:
        allowed += " or null"
    return field.description or "", allowed


_SIGNS = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}


def _console() -> Console:
    console = Console()
    return console if console.is_terminal else Console(width=160)
