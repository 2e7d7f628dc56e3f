"""A record without its fields: what tables, plans and forecasts are made of, kept as text beside it."""

import json
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr
from pydantic_core import from_json

from sphstudy.store.record import STATUS

GROUPS = ("metric", "cost")
"""Single numbers of these groups are part of a summary."""


@dataclass(frozen=True)
class Summary:
    """Outcome, global attributes, metrics and cost by name, and the attributes of each of these (units,
    long_name, …), which summaries share: not to be changed.
    """

    status: str
    attributes: dict[str, Any]
    numbers: dict[str, float]
    described: dict[str, dict[str, Any]]

    @property
    def text(self) -> str:
        """As two lines of JSON."""
        own = json.dumps([self.status, self.attributes, self.numbers])
        return f"{own}\n{json.dumps(self.described)}"


def of_text(text: str) -> Summary:
    """The summary that a text was made from. Raises ValueError if there is none."""
    # The second line is the same of nearly all records, and read once.
    first, _, second = text.partition("\n")
    try:
        status, attributes, numbers = from_json(first)
        described = _described(second)
        if numbers.keys() != described.keys():
            raise ValueError("numbers without a description, or the other way round")
    except (TypeError, AttributeError) as error:
        raise ValueError(f"not a summary ({error})") from None
    if status not in STATUS[1:]:
        raise ValueError(f"outcome {status}")
    return Summary(status, attributes, numbers, described)


def of_record(run: xr.Dataset) -> Summary:
    """The summary of a record. Raises ValueError or LookupError if it has no outcome."""
    code = int(run["status"])
    if not 0 < code < len(STATUS):
        raise ValueError(f"outcome {code}")
    told = {
        str(name): v
        for name, v in run.data_vars.items()
        if v.ndim == 0 and v.attrs.get("group") in GROUPS
    }
    return Summary(
        STATUS[code],
        _plain(run.attrs),
        {name: float(v.values) for name, v in told.items()},
        {name: _plain(v.attrs) for name, v in told.items()},
    )


def _plain(attributes: dict[Any, Any]) -> dict[str, Any]:
    return {str(name): plain(value) for name, value in attributes.items()}


def plain(value: Any) -> Any:
    """An attribute of a netCDF file as JSON can keep it."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


@lru_cache(maxsize=256)
def _described(text: str) -> dict[str, dict[str, Any]]:
    return json.loads(text)
