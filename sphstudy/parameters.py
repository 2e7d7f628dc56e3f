"""Building blocks of validated parameters: frozen dataclasses whose fields carry range and meaning.

Values live in `conf/`; here stand types, ranges, units and meanings, which `sphstudy describe` prints.
"""

from typing import Annotated

from pydantic import ConfigDict, Field
from pydantic.dataclasses import dataclass as _dataclass

_STRICT = ConfigDict(extra="forbid", allow_inf_nan=False)


def parameters(cls):
    """Class decorator: a frozen, keyword-only dataclass that refuses unknown keys, NaN, infinity."""
    return _dataclass(frozen=True, kw_only=True, config=_STRICT)(cls)


def number(meaning: str, unit: str = "1", **limits):
    """A float with meaning, unit and limits (gt, ge, lt, le)."""
    return Annotated[float, Field(description=f"{meaning} [{unit}]", **limits)]


def count(meaning: str, **limits):
    """A whole number with meaning and limits."""
    return Annotated[int, Field(description=meaning, strict=True, **limits)]


def text(meaning: str):
    """Free text with a meaning."""
    return Annotated[str, Field(description=meaning)]


def optional(kind):
    """The same, or null."""
    return kind | None


def described(kind, meaning: str):
    """Any type with a meaning: choices (Literal), switches, lists."""
    return Annotated[kind, Field(description=meaning)]
