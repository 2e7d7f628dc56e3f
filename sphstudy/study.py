"""Named studies: a YAML file in `studies/` with blocks, each a grid of settings.

    title: what it is
    blocks:
      - {scene: mode1, method: thesis, h: [1.3, 1.5], n: [40, 50, 60]}
    include: [plate]        # blocks of other studies, optional

A list in a block is swept; to give a setting that is itself a list, write it as a string: "[1.5, 3]".
"""

from pathlib import Path
from typing import Any

import yaml
from pydantic import TypeAdapter, ValidationError

from sphstudy.config import ConfigurationError
from sphstudy.parameters import described, parameters

Setting = int | float | str | bool | None


@parameters
class Study:
    """What a study file holds."""

    title: str = described("what it is")
    blocks: list[dict[str, Setting | list[Setting]]] = described("grids of settings")
    include: list[str] = described("studies whose blocks belong to this one")


def folder() -> Path:
    """The folder `studies`: inside the package when installed, beside it in a checkout."""
    inside = Path(__file__).parent / "studies"
    return inside if inside.is_dir() else Path(__file__).parent.parent / "studies"


def names() -> list[str]:
    """Names of all studies."""
    return sorted(path.stem for path in folder().glob("*.yaml"))


def load(name: str) -> Study:
    """The study of that name. Raises ConfigurationError if there is none or its file is wrong."""
    if name not in names():
        raise ConfigurationError([f"study {name}: there is {', '.join(names())}"])
    path = folder() / f"{name}.yaml"
    try:
        values = {"blocks": [], "include": [], **yaml.safe_load(path.read_text())}
        return TypeAdapter(Study).validate_python(values)
    except (yaml.YAMLError, TypeError) as error:
        raise ConfigurationError([f"{path.name}: {' '.join(str(error).split())}"]) from None
    except ValidationError as error:
        raise ConfigurationError(
            [f"{path.name}: {'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors()]
        ) from None


def grids(name: str, above: tuple[str, ...] = ()) -> list[list[str]]:
    """The overrides of every block of a study and of the studies it includes."""
    if name in above:
        raise ConfigurationError([f"study {name}: includes itself ({' > '.join((*above, name))})"])
    study = load(name)
    own = [[f"{key}={_text(value)}" for key, value in block.items()] for block in study.blocks]
    return own + [grid for inner in study.include for grid in grids(inner, (*above, name))]


def _text(value: Any) -> str:
    if isinstance(value, list):
        return ",".join(_text(item) for item in value)
    return "null" if value is None else str(value)
