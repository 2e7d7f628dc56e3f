"""What a sound run keeps: bounds with reasons, from the file of a scene (conf/scene).

    source: where the case comes from
    bounds:
      <metric of the record>: {at_most: 1.0e-4, reason: why this number}
      history.<indicator>: {at_least: 0.3, reason: …}        # of stability.indicators, at any sample
      <metric>:                                              # several, each for some of the points
        - {where: {n: 10}, at_most: 0.013, reason: …}
        - {where: {n: 20}, at_most: 0.003, reason: …}
    quoted:                       # what others found, to be shown beside; nothing is judged by it
      - {quantity: period, units: s, between: [0.283, 0.285], source: where it is printed}

`conf/bounds.yaml` holds for every scene. What a scene says of the same quantity replaces it.
"""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from sphstudy import catalogue
from sphstudy.analysis.stability.indicators import INDICATORS
from sphstudy.configuration.study_file import Values, holds
from sphstudy.errors import ConfigurationError, unknown
from sphstudy.parameters import described, number, parameters

HISTORY = "history."
"""Begins the names of quantities that have a value at each sample."""

_SECTIONS = ("source", "bounds", "quoted")


@parameters
class Quoted:
    """What others found for a scene."""

    quantity: str = described("a metric of the scene's records")
    units: str = described("UDUNITS")
    between: tuple[float, float] = described("smallest and largest value found")
    source: str = described("who found it, and where it is printed")


@parameters
class _Sections:
    source: str = described("where the case comes from")
    bounds: dict[str, Any] = described("bound, or several, of each quantity")
    quoted: list[Quoted] = described("what others found")


@parameters
class Bound:
    """An interval for a quantity."""

    quantity: str = described("a metric, or an indicator at each sample, with HISTORY in front")
    at_most: float | None = number("largest value of a sound run")
    at_least: float | None = number("smallest value of a sound run")
    where: dict[str, Values] = described("settings of the points that it is for; a list: any of these")
    reason: str = described("why this number")
    source: str = described("where the case comes from")
    general: bool = described("whether every scene has it")

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
        """How far values [K] lie outside [K]: negative inside, NaN where there is no value."""
        above = values - (np.inf if self.at_most is None else self.at_most)
        below = (-np.inf if self.at_least is None else self.at_least) - values
        return np.maximum(above, below)


def for_point(scene: str, flat: dict[str, Any]) -> list[Bound]:
    """Bounds of a point, those that every scene has last.

    Parameters
    ----------
    scene : str
        Its name.
    flat : dict
        The configuration of the point, with flat keys.

    Raises
    ------
    ConfigurationError
        With every complaint about the bounds of the scene, or about the general ones.
    """
    own = _of_scene(scene)[0]
    named = {bound.quantity for bound in own}
    both = [*own, *(bound for bound in _of_scene(None)[0] if bound.quantity not in named)]
    return [bound for bound in both if holds(bound.where, flat)]


def quoted(scene: str) -> list[Quoted]:
    """What others found for a scene. Raises ConfigurationError as `for_point`."""
    return _of_scene(scene)[1]


def check() -> None:
    """Raises ConfigurationError with every complaint about the bounds of any scene."""
    complaints = []
    for scene in catalogue.names("scene"):
        try:
            for_point(scene, {})
        except ConfigurationError as error:
            complaints += error.complaints
    if complaints:
        raise ConfigurationError(list(dict.fromkeys(complaints)))


def _of_scene(scene: str | None) -> tuple[list[Bound], list[Quoted]]:
    """Bounds of a scene or, with None, of all."""
    # A configuration that was stored may name a scene that does not exist any more.
    if scene is not None and scene not in catalogue.names("scene"):
        return [], []
    return _read(scene, tuple(catalogue.settings_folders()))


@cache
def _read(scene: str | None, folders: tuple[Path, ...]) -> tuple[list[Bound], list[Quoted]]:
    if scene is None:
        place = "bounds.yaml"
        sections = catalogue.read(next(p for f in folders if (p := f / place).is_file()))
    else:
        place, settings = f"scene/{scene}.yaml", catalogue.settings("scene", scene)
        sections = {section: settings[section] for section in _SECTIONS if section in settings}
        if not sections:
            return [], []
    try:
        file = TypeAdapter(_Sections).validate_python({"quoted": [], **sections})
    except ValidationError as error:
        raise ConfigurationError(_complaints(place, error)) from None
    complaints: list[str] = []
    fixed = {"source": file.source, "general": scene is None}
    given = [
        (quantity, one)
        for quantity, several in file.bounds.items()
        for one in (several if isinstance(several, list) else [several])
    ]
    found = [
        _bound(f"{place}: {quantity}", one, {**fixed, "quantity": quantity}, complaints)
        for quantity, one in given
    ]
    if complaints:
        raise ConfigurationError(complaints)
    return [bound for bound in found if bound is not None], file.quoted


def _bound(place: str, given: Any, fixed: dict[str, Any], complaints: list[str]) -> Bound | None:
    """One bound; complaints are added."""
    quantity = fixed["quantity"]
    if quantity.startswith(HISTORY) and (name := quantity.removeprefix(HISTORY)) not in INDICATORS:
        complaints.append(f"{place}: {unknown('indicator', name, INDICATORS)}")
    if not isinstance(given, dict):
        complaints.append(f"{place}: should be a mapping with at_most or at_least, and reason")
        return None
    try:
        optional: dict[str, Any] = {"at_most": None, "at_least": None, "where": {}}
        bound = TypeAdapter(Bound).validate_python({**optional, **given, **fixed})
    except ValidationError as error:
        complaints += _complaints(place, error)
        return None
    if bound.at_most is None and bound.at_least is None:
        complaints.append(f"{place}: neither at_most nor at_least")
    elif bound.at_most is not None and bound.at_least is not None and bound.at_most < bound.at_least:
        complaints.append(f"{place}: at_most is less than at_least")
    if not bound.reason.strip():
        complaints.append(f"{place}: reason: is empty")
    return bound


def _complaints(place: str, error: ValidationError) -> list[str]:
    found = (": ".join(filter(None, [".".join(map(str, e["loc"])), e["msg"]])) for e in error.errors())
    return [f"{place}: {text}" for text in found]
