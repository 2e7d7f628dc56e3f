"""Which settings were swept: they are the dimensions of a combined dataset."""

import itertools
import json
import math
from typing import Any

import numpy as np

ALWAYS = ("h", "n")
"""Dimensions of every combined dataset, swept or not."""


def dimensions(flat: list[dict[str, Any]]) -> dict[str, list[Any]]:
    """The settings that differ between runs, h and n in any case.

    Settings that follow from the choice of scene, method or solver, varying only along with it, are left
    out.

    Parameters
    ----------
    flat : list of dict
        Flat configuration of each run.

    Returns
    -------
    dict
        Flat key: its values in order of appearance, numbers sorted.
    """
    swept = {}
    for key in dict.fromkeys(itertools.chain.from_iterable(flat)):
        column = [point.get(key) for point in flat]
        if key not in ALWAYS and column.count(column[0]) == len(column):
            continue
        values = list(dict.fromkeys(map(hashable, column)))
        if len(values) > 1 or key in ALWAYS:
            numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)
            swept[key] = sorted(values) if numbers else values
    choices = tuple(key for key in ("scene", "method", "solve") if key in swept)
    if not choices:
        return swept
    kept = {*choices, *ALWAYS}
    return {key: v for key, v in swept.items() if key in kept or not _follows(key, choices, flat)}


def _follows(key: str, choices: tuple[str, ...], flat: list[dict[str, Any]]) -> bool:
    """Whether a setting has one value for each combination of choices."""
    by_choice: dict[tuple, set] = {}
    for point in flat:
        by_choice.setdefault(tuple(point.get(c) for c in choices), set()).add(hashable(point.get(key)))
    return all(len(values) == 1 for values in by_choice.values())


def hashable(value: Any) -> Any:
    """The value itself if it is a number or text, else its JSON text; "null" for NaN, which tables have
    in place of a setting that a run lacks.
    """
    if isinstance(value, float) and math.isnan(value):
        return "null"
    return value if isinstance(value, int | float | str | np.generic) else json.dumps(value)
