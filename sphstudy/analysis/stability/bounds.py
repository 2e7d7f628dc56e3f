"""What a sound run keeps: bounds with reasons, from `conf/bounds/<scene>.yaml`.

    source: where the case comes from
    bounds:
      <metric of the record>: {at_most: 1.0e-4, reason: why this number}
      history.<indicator>: {at_least: 0.3, reason: …}        # of stability.indicators, at any sample
      <metric>:                                              # several, each for some of the points
        - {where: {n: 10}, at_most: 0.013, reason: …}
        - {where: {n: 20}, at_most: 0.003, reason: …}
    quoted:                       # what others found, to be shown beside; nothing is judged by it
      - {quantity: period, units: s, between: [0.283, 0.285], source: where it is printed}

`any.yaml` holds for every scene; what a scene says of the same quantity stands in its place.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from pydantic import TypeAdapter, ValidationError

from sphstudy import catalogue
from sphstudy.analysis.stability.indicators import INDICATORS
from sphstudy.configuration.study_file import Values, holds
from sphstudy.errors import ConfigurationError
from sphstudy.parameters import described, number, parameters

GENERAL = "any"
"""The file of bounds that every scene has."""

HISTORY = "history."
"""Begins the names of quantities that have a value at each sample."""


@parameters
class _Bound:
    at_most: float | None = number("largest value of a sound run")
    at_least: float | None = number("smallest value of a sound run")
    where: dict[str, Values] = described("settings of the points that it is for; a list: any of these")
    reason: str = described("why this number")


@parameters
class Quoted:
    """What others found for a scene."""

    quantity: str = described("a metric of the scene's records")
    units: str = described("UDUNITS")
    between: tuple[float, float] = described("smallest and largest value found")
    source: str = described("who found it, and where it is printed")


@parameters
class _File:
    source: str = described("where the case comes from")
    bounds: dict[str, Any] = described("bound, or several, of each quantity")
    quoted: list[Quoted] = described("what others found")


@dataclass(frozen=True)
class Bound:
    """An interval for a quantity: a metric, or with HISTORY in front an indicator at each sample.

    where: settings (flat keys) of the points that it is for. source: where its file says it comes from.
    general: whether every scene has it.
    """

    quantity: str
    at_most: float | None
    at_least: float | None
    where: dict[str, Values]
    reason: str
    source: str
    general: bool

    @property
    def indicator(self) -> str:
        """Name of the indicator; "" where the quantity is a metric."""
        return self.quantity.removeprefix(HISTORY) if self.quantity.startswith(HISTORY) else ""

    @property
    def interval(self) -> str:
        """The bound in words."""
        limits = (("at least", self.at_least), ("at most", self.at_most))
        return ", ".join(f"{words} {limit:g}" for words, limit in limits if limit is not None)

    def excess(self, values: np.ndarray) -> np.ndarray:
        """How far values lie outside: negative inside, NaN where there is none."""
        above = values - (np.inf if self.at_most is None else self.at_most)
        below = (-np.inf if self.at_least is None else self.at_least) - values
        return np.maximum(above, below)


def for_point(scene: str, flat: dict[str, Any]) -> list[Bound]:
    """Bounds of a point of this scene with these settings, those that every scene has last.

    Raises ConfigurationError with every complaint about the files.
    """
    return [bound for bound in of_scene(scene) if holds(bound.where, flat)]


def of_scene(scene: str) -> list[Bound]:
    """All bounds of a scene, whatever the settings. Raises ConfigurationError as `for_point`."""
    own = read(scene) if _path(scene).is_file() else []
    named = {bound.quantity for bound in own}
    return [*own, *(bound for bound in read(GENERAL) if bound.quantity not in named)]


def check() -> None:
    """Raises ConfigurationError with every complaint about any file of bounds."""
    complaints = []
    for path in sorted(_folder().glob("*.yaml")):
        try:
            read(path.stem)
        except ConfigurationError as error:
            complaints += error.complaints
    if complaints:
        raise ConfigurationError(complaints)


def quoted(scene: str) -> list[Quoted]:
    """What others found for a scene. Raises ConfigurationError as `read`."""
    return _read(_path(scene))[1] if _path(scene).is_file() else []


def read(name: str) -> list[Bound]:
    """The bounds of one file. Raises ConfigurationError with every complaint, naming file and key."""
    return _read(_path(name))[0]


def _path(name: str) -> Path:
    return _folder() / f"{name}.yaml"


def _folder() -> Path:
    return catalogue.folder("conf") / "bounds"


@cache
def _read(path: Path) -> tuple[list[Bound], list[Quoted]]:
    complaints: list[str] = []
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
        # What is no mapping is left for the validation to refuse.
        values = {"quoted": []} | values if isinstance(values, dict) else values
        file = TypeAdapter(_File).validate_python(values)
    except yaml.YAMLError as error:
        raise ConfigurationError([f"bounds/{path.name}: {' '.join(str(error).split())}"]) from None
    except ValidationError as error:
        raise ConfigurationError(_complaints(f"bounds/{path.name}", error)) from None
    found = []
    for quantity, given in file.bounds.items():
        name, place = quantity.removeprefix(HISTORY), f"bounds/{path.name}: {quantity}"
        if quantity.startswith(HISTORY) and name not in INDICATORS:
            complaints.append(f"{place}: there is no such indicator (there are {', '.join(INDICATORS)})")
        for one in given if isinstance(given, list) else [given]:
            try:
                optional: dict[str, Any] = {"at_most": None, "at_least": None, "where": {}}
                bound = TypeAdapter(_Bound).validate_python({**optional, **one})
            except TypeError:
                complaints.append(f"{place}: should be a mapping with at_most or at_least, and reason")
            except ValidationError as error:
                complaints += _complaints(place, error)
            else:
                complaints += [f"{place}: {wrong}" for wrong in _wrong(bound)]
                limits = (bound.at_most, bound.at_least, bound.where, bound.reason)
                found.append(Bound(quantity, *limits, file.source, general=path.stem == GENERAL))
    if complaints:
        raise ConfigurationError(complaints)
    return found, file.quoted


def _wrong(bound: _Bound) -> list[str]:
    wrong = []
    if bound.at_most is None and bound.at_least is None:
        wrong.append("neither at_most nor at_least")
    elif bound.at_most is not None and bound.at_least is not None and bound.at_most < bound.at_least:
        wrong.append("at_most is less than at_least")
    if not bound.reason.strip():
        wrong.append("reason: is empty")
    return wrong


def _complaints(place: str, error: ValidationError) -> list[str]:
    found = (": ".join(filter(None, [".".join(map(str, e["loc"])), e["msg"]])) for e in error.errors())
    return [f"{place}: {text}" for text in found]
