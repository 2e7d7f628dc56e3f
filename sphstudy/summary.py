"""A record without its fields: what tables, plans and forecasts are made of, kept as text beside it."""

import json
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr

from sphstudy.record import STATUS

GROUPS = ("metric", "cost")
"""Single numbers of these groups are part of a summary."""


@dataclass(frozen=True)
class Summary:
    """Outcome, global attributes, and each metric and cost with its own attributes (units, long_name, …),
    which summaries share: not to be changed.
    """

    status: str
    attributes: dict[str, Any]
    numbers: dict[str, tuple[float, dict[str, Any]]]

    @property
    def text(self) -> str:
        """As two lines of JSON."""
        values = {name: value for name, (value, _) in self.numbers.items()}
        described = {name: own for name, (_, own) in self.numbers.items()}
        return json.dumps([self.status, self.attributes, values]) + "\n" + json.dumps(described)


def of_text(text: str) -> Summary:
    """The summary that a text was made from. Raises ValueError if there is none."""
    # The second line is the same of nearly all records, and read once.
    first, _, second = text.partition("\n")
    try:
        status, attributes, values = json.loads(first)
        own = _described(second)
        numbers = {name: (value, own[name]) for name, value in values.items()}
    except (TypeError, LookupError, AttributeError) as error:
        raise ValueError(f"not a summary ({error})") from None
    if status not in STATUS[1:]:
        raise ValueError(f"outcome {status}")
    return Summary(status, attributes, numbers)


def of_record(run: xr.Dataset) -> Summary:
    """The summary of a record. Raises ValueError or LookupError if it has no outcome."""
    code = int(run["status"])
    if not 0 < code < len(STATUS):
        raise ValueError(f"outcome {code}")
    numbers = {
        str(name): (float(v.values), {key: plain(own) for key, own in v.attrs.items()})
        for name, v in run.data_vars.items()
        if v.ndim == 0 and v.attrs.get("group") in GROUPS
    }
    return Summary(STATUS[code], {name: plain(value) for name, value in run.attrs.items()}, numbers)


def plain(value: Any) -> Any:
    """An attribute of a netCDF file as JSON can keep it."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


@lru_cache(maxsize=256)
def _described(text: str) -> dict[str, dict[str, Any]]:
    return json.loads(text)
