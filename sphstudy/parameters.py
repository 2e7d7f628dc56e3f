"""Building blocks of validated parameters: frozen dataclasses whose fields carry range and meaning.

Values are in `conf/`; classes declare types, ranges, units and meanings: `sphstudy describe` prints all.
"""

import dataclasses
from functools import cache
from typing import Any, TypeVar, dataclass_transform

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as _dataclass

T = TypeVar("T")
LARGEST_COUNT = 10**9
"""Of whatever is counted: particles along a side, steps. More are a slip of the pen."""

LARGEST, SMALLEST = 1e50, 1e-50
"""Sizes of real numbers, in their units: products of several are numbers still."""

_STRICT = ConfigDict(extra="forbid", allow_inf_nan=False)


def number(meaning: str, unit: str = "1", **limits: float) -> Any:
    """A field that takes a real number.

    Parameters
    ----------
    meaning, unit : str
        For `sphstudy describe`; "1" is the unit of a pure number.
    **limits : float
        What the number is above (`gt`, `ge`) and below (`lt`, `le`).
    """
    return Field(description=f"{meaning} [{unit}]", **limits)  # type: ignore[call-overload]


def count(meaning: str, **limits: int) -> Any:
    """A field that takes a whole number, at most LARGEST_COUNT; parameters as those of `number`."""
    return Field(description=meaning, strict=True, **{"le": LARGEST_COUNT} | limits)  # type: ignore[call-overload]


def described(meaning: str) -> Any:
    """A field that takes anything else: text, choices (Literal), switches, lists."""
    return Field(description=meaning)


@dataclass_transform(
    frozen_default=True, kw_only_default=True, field_specifiers=(number, count, described)
)
def parameters(cls: type[T]) -> type[T]:
    """Class decorator: a frozen, keyword-only dataclass that refuses unknown keys, NaN, infinity."""
    return _dataclass(frozen=True, kw_only=True, config=_STRICT)(cls)  # type: ignore[return-value]


@cache
def adapter(cls: Any) -> TypeAdapter:
    """Pydantic's adapter of a class of parameters, made once."""
    return TypeAdapter(cls)


def checked(cls: type, values: Any, prefix: str, complaints: list[str]) -> Any:
    """Values as an instance of a class of parameters.

    Parameters
    ----------
    cls : type
        The class.
    values : Any
        A mapping of values by name.
    prefix : str
        What stands before the names in complaints: "scene.".
    complaints : list of str
        Every complaint is added here.

    Returns
    -------
    Any
        The instance; None if there is a complaint.
    """
    try:
        made = adapter(cls).validate_python(values)
        complaints += [
            f"{prefix}{name}={value:g}: should be 0, or {SMALLEST:g} to {LARGEST:g} in size"
            for name, value in vars(made).items()
            if isinstance(value, float) and value and not SMALLEST <= abs(value) <= LARGEST
        ]
        return made
    except ValidationError as error:
        for item in error.errors():
            key = prefix + ".".join(str(part) for part in item["loc"])
            message = item["msg"].removeprefix("Input ").removeprefix("Value error, ")
            if item["type"] in ("unexpected_keyword_argument", "extra_forbidden"):
                allowed = ", ".join(sorted(field.name for field in dataclasses.fields(cls)))
                message = f"there is no such key (there are {allowed})"
            complaints.append(f"{key}={shown(item['input'])}: {message}")
        return None


def shown(given: Any) -> str:
    """What was given, as far as a message should repeat it: no control characters, no pages."""
    text = str(given)
    text = text if text.isprintable() else repr(text)
    return text if len(text) <= 60 else f"{text[:60]}…"
