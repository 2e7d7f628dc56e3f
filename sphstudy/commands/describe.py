"""Every setting of a scene, method or solver.

    sphstudy describe [scene|method|solve] NAME

Prints key, value, allowed range, unit and meaning of each setting.

    sphstudy describe scene plate
    sphstudy describe tl                       the method of that name
"""

from collections.abc import Iterator
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from sphstudy import catalogue
from sphstudy.catalogue import method_module, scene_module, solver_module
from sphstudy.commands.list import PLACES, about
from sphstudy.commands.parser import Request
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.console import print_table
from sphstudy.errors import ConfigurationError, unknown
from sphstudy.table import Column, Table
from sphstudy.text import setting

_MODULES = {"scene": scene_module, "method": method_module, "solve": solver_module}
_SIGNS = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}


def run(request: Request) -> int:
    """Prints the settings of a scene, method or solver as a table."""
    group, name = _named(request)
    settings = catalogue.settings(group, name)
    print(f"{group}={name}: {about(group, name)}")
    columns = [Column(heading, numeric=False) for heading in ("key", "value", "allowed", "meaning")]
    print_table(Table.of_texts(columns, list(_rows(group, settings))))
    return 0


def _named(request: Request) -> tuple[str, str]:
    *groups, name = request.words
    known = {group: catalogue.names(group) for group in PLACES}
    owners = groups or [group for group in PLACES if name in known[group]]
    if not owners:
        every = [name for names in known.values() for name in names]
        raise ConfigurationError([unknown("scene, method or solver", name, every)])
    if owners[0] not in PLACES:
        raise request.misused()
    if name not in known[owners[0]]:
        raise ConfigurationError([unknown(owners[0], name, known[owners[0]])])
    return owners[0], name


def _rows(group: str, settings: dict[str, Any]) -> Iterator[list[str]]:
    values = settings.get(group, settings)
    module = _MODULES[group](values[PLACES[group][0]])
    if group == "scene":
        common = catalogue.read(catalogue.folder("conf") / "config.yaml") | settings
        for key in ("h", "n"):
            field = RunConfig.__pydantic_fields__[key]  # type: ignore[attr-defined]
            yield [key, setting(common[key]), _allowed(field), field.description or ""]
    for key, field in module.Parameters.__pydantic_fields__.items():
        if key not in ("name", "kind"):
            value = values.get(key, field.default)
            yield [f"{group}.{key}", setting(value), _allowed(field), field.description or ""]


def _allowed(field: FieldInfo) -> str:
    """Choices or limits of a setting."""
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
    return f"{allowed} or null".strip() if type(None) in kinds else allowed
