"""Comparison of a study's metrics with accepted intervals: worst first, and a verdict for each."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from sphstudy.analysis import reference
from sphstudy.analysis.cells import cells
from sphstudy.analysis.dimensions import hashable
from sphstudy.analysis.results import Results
from sphstudy.configuration import study_file

WITHIN, OUTSIDE, UNSTABLE, MISSING = "within", "outside", "unstable", "missing"
"""Verdicts. UNSTABLE: the cell sits in an instability and is not judged; MISSING: there is no value."""


@dataclass(frozen=True)
class Comparison:
    """One metric of one cell against its accepted interval.

    cell: the settings that tell it from the study's other cells. excess: distance of the value from the
    middle of the interval, in half-widths (more than 1: outside). reason: why the interval is as wide.
    """

    study: str
    metric: str
    cell: str
    value: float
    lower: float
    upper: float
    units: str
    verdict: str
    excess: float
    reason: str


def against_reference(results: Results) -> list[Comparison]:
    """Every metric of every cell of the stored references of the study and of those it includes.

    A point belongs to the cell with its coordinates, whatever else is set: a default that has changed
    shows in the values. Cells of a reference that are no points of the results are left out, and so are
    points that the reference lacks. Worst first.
    """
    found: list[Comparison] = []
    for member in study_file.members(results.name):
        stored = reference.load(member)
        if stored is None:
            continue
        unstable = study_file.load(member).unstable
        rows = results.table[results.table["study"] == member]
        for cell in cells(stored):
            row = _matching(rows, cell.place)
            if row is None:
                continue
            reasons = [u.reason for u in unstable if u.holds(cell.flat)]
            for metric in reference.metrics(stored):
                tolerance = reference.tolerance(stored, metric)
                if tolerance is None or math.isnan(middle := cell.values[metric]):
                    continue
                value = float(row.get(metric, math.nan))
                lower, upper = middle - tolerance.half_width, middle + tolerance.half_width
                verdict = UNSTABLE if reasons else _verdict(value, lower, upper, row["status"])
                found.append(
                    _comparison(
                        member, metric, cell.label, value, lower, upper,
                        stored[metric].attrs["units"], verdict, (*reasons, tolerance.reason)[0],
                    )
                )  # fmt: skip
    return _worst_first(found)


def against_thesis(results: Results) -> list[Comparison]:
    """Metrics against the ranges that the thesis's text and axes give. Worst first."""
    found: list[Comparison] = []
    for entry in reference.printed():
        rows = results.table[(results.table["study"] == entry.study)]
        for key, value in {"block": entry.block, **entry.where}.items():
            rows = rows[rows[key].isin(value if isinstance(value, list) else [value])]
        units = str(results.attributes.get(entry.metric, {}).get("units", "1"))
        for _, row in rows.iterrows():
            value = float(row.get(entry.metric, math.nan))
            verdict = _verdict(value, entry.lower, entry.upper, row["status"])
            found.append(
                _comparison(
                    entry.study, entry.metric, f"h={row['h']:g} n={row['n']}", value,
                    entry.lower, entry.upper, units, verdict, entry.source,
                )
            )  # fmt: skip
    return _worst_first(found)


def between(after: xr.Dataset, before: xr.Dataset, tolerance: float) -> list[Comparison]:
    """All metrics of two combined datasets, cell by cell; `tolerance` is relative to the value before.

    Where `before` is a stored reference, its own intervals hold. Cells and metrics that `after` lacks are
    there as missing. Raises ValueError if either is not a combined dataset, or if several cells of
    `after` stand for one of `before`.
    """
    now = cells(after)
    found: list[Comparison] = []
    for cell in cells(before):
        matches = [c for c in now if _agree(c.flat, cell.place)]
        if len(matches) > 1:
            raise ValueError(f"{len(matches)} cells of the one dataset are {cell.label} of the other")
        values = matches[0].values if matches else {}
        status = matches[0].status if matches else "missing"
        for metric in reference.metrics(before):
            old, value = cell.values[metric], values.get(metric, math.nan)
            if math.isnan(old):
                continue
            own = reference.tolerance(before, metric)
            half = own.half_width if own else tolerance * abs(old)
            lower, upper = old - half, old + half
            reason = own.reason if own else f"{tolerance:g} of the value before"
            verdict = _verdict(value, lower, upper, status if metric in values else "missing")
            units = before[metric].attrs["units"]
            found.append(_comparison("", metric, cell.label, value, lower, upper, units, verdict, reason))
    return _worst_first(found)


def _matching(rows: pd.DataFrame, place: dict[str, Any]) -> pd.Series | None:
    """The row at these coordinates."""
    for _, row in rows.iterrows():
        if _agree(row, place):
            return row
    return None


def _agree(settings: Any, place: dict[str, Any]) -> bool:
    return all(_plain(settings.get(key)) == _plain(v) for key, v in place.items())


def _plain(value: Any) -> float | str:
    """A setting in the one form in which tables and coordinates can be told equal.

    Coordinates that are a mixture of numbers and words are all written as words, columns of a table that
    lack a whole number in some rows have only fractions.
    """
    value = hashable(value)
    if isinstance(value, bool | np.bool_):
        return str(value)
    try:
        return float(value)
    except ValueError:
        return str(value)


def _verdict(value: float, lower: float, upper: float, status: str) -> str:
    if math.isnan(value):
        return MISSING if status == "missing" else OUTSIDE
    return WITHIN if lower <= value <= upper else OUTSIDE


def _comparison(
    member: str, metric: str, cell: str, value: float, lower: float, upper: float,
    units: str, verdict: str, reason: str,
) -> Comparison:  # fmt: skip
    half = 0.5 * (upper - lower)
    away = abs(value - 0.5 * (upper + lower))
    excess = away / half if half > 0.0 else (0.0 if away == 0.0 else math.inf)
    if verdict == OUTSIDE and math.isnan(value):
        excess = math.inf
    return Comparison(member, metric, cell, value, lower, upper, units, verdict, excess, reason)


def _worst_first(found: list[Comparison]) -> list[Comparison]:
    ranks = {OUTSIDE: 0, MISSING: 1, WITHIN: 2, UNSTABLE: 3}
    return sorted(found, key=lambda c: (ranks[c.verdict], -c.excess if c.excess == c.excess else 0.0))
