"""Building blocks of validated parameters: frozen dataclasses whose fields carry range and meaning.

Values live in `conf/`; here stand types, ranges, units and meanings, which `sphstudy describe` prints.
"""

import dataclasses
from functools import cache
from typing import Any, TypeVar, dataclass_transform

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as _dataclass

T = TypeVar("T")
_STRICT = ConfigDict(extra="forbid", allow_inf_nan=False)


def number(meaning: str, unit: str = "1", **limits: float) -> Any:
    """A float with meaning, unit and limits (gt, ge, lt, le)."""
    return Field(description=f"{meaning} [{unit}]", **limits)  # type: ignore[call-overload]


def count(meaning: str, **limits: int) -> Any:
    """A whole number with meaning and limits."""
    return Field(description=meaning, strict=True, **limits)  # type: ignore[call-overload]


def described(meaning: str) -> Any:
    """Anything else with a meaning: text, choices (Literal), switches, lists."""
    return Field(description=meaning)


@dataclass_transform(
    frozen_default=True, kw_only_default=True, field_specifiers=(number, count, described)
)
def parameters(cls: type[T]) -> type[T]:
    """Class decorator: a frozen, keyword-only dataclass that refuses unknown keys, NaN, infinity."""
    return _dataclass(frozen=True, kw_only=True, config=_STRICT)(cls)  # type: ignore[return-value]


@cache
def adapter(cls: Any) -> TypeAdapter:
    """What checks values against a class of parameters, made once."""
    return TypeAdapter(cls)


def checked(cls: type, values: Any, prefix: str, complaints: list[str]) -> Any:
    """The values as an instance of a class of parameters; None, and complaints added, if they are not."""
    try:
        return adapter(cls).validate_python(values)
    except ValidationError as error:
        for item in error.errors():
            key = prefix + ".".join(str(part) for part in item["loc"])
            message = item["msg"].removeprefix("Input ").removeprefix("Value error, ")
            if item["type"] in ("unexpected_keyword_argument", "extra_forbidden"):
                allowed = ", ".join(sorted(field.name for field in dataclasses.fields(cls)))
                message = f"there is no such key (there are {allowed})"
            complaints.append(f"{key}={item['input']}: {message}")
        return None
