"""Which setting to choose for an error, from the stored points of a study, and what that rests on."""

import math
import shlex
from collections.abc import Iterator
from typing import Any

import pandas as pd
import xarray as xr

from sphstudy.analysis import work_precision
from sphstudy.analysis.cells import cells
from sphstudy.analysis.richardson import Extrapolation, extrapolate
from sphstudy.analysis.work_precision import Choice
from sphstudy.configuration.composition import Session
from sphstudy.errors import ConfigurationError
from sphstudy.text import percent, setting

FINEST = 3
"""Resolutions that an extrapolation rests on."""

WHOLE = 0.2
"""An observed order that is no farther than this from a whole number counts as that number."""


def table(dataset: xr.Dataset) -> pd.DataFrame:
    """The points of a combined dataset as `work_precision.points` takes them.

    Parameters
    ----------
    dataset : xarray.Dataset
        A combined dataset.

    Returns
    -------
    pandas.DataFrame
        A row with settings, status, record, metrics and cost of each point.
    """
    return pd.DataFrame(
        [
            {**cell.flat, **cell.values, "status": cell.status, "record": k}
            for k, cell in enumerate(cells(dataset))
        ]
    )


def chosen(found: pd.DataFrame, wanted: dict[str, str], study: str) -> pd.DataFrame:
    """The points of a scene, with their errors.

    Parameters
    ----------
    found : pandas.DataFrame
        As `table` returns it.
    wanted : dict
        scene, and if they are asked for method, solve and metric.
    study : str
        Whose points they are, for complaints.

    Raises
    ------
    ConfigurationError
        If no point is of that scene, method and solver, or if none of them is done.
    """
    for key in ("scene", "method", "solve"):
        if key in wanted:
            there = list(dict.fromkeys(found[key]))
            if wanted[key] not in there:
                raise ConfigurationError([f"{key}={wanted[key]}: in study {study} is {', '.join(there)}"])
            found = found[found[key] == wanted[key]]
    points = work_precision.points(found, wanted["scene"], wanted.get("metric"))
    if points["error"].isna().all():
        where = " ".join(f"{key}={value}" for key, value in wanted.items())
        raise ConfigurationError([f"{where}: study {study} has no point of it that is done"])
    return points


def command(row: pd.Series, hydra: Session) -> str:
    """The command line that makes a run.

    Parameters
    ----------
    row : pandas.Series
        A row of `chosen`.
    hydra : Session
        Knows the defaults, which are left out.
    """
    flat = {key: row[key] for key in work_precision.settings(row.index)}
    named = [f"{key}={setting(flat[key])}" for key in ("scene", "method", "solve", "h", "n")]
    usual = hydra.points(named, sweep=False)[0][0].config.flat()
    changed = [
        f"{key}={setting(flat[key])}" for key, value in usual.items() if not _same(flat[key], value)
    ]
    return " ".join(["sphstudy", *map(shlex.quote, named + changed)])


def _same(one: Any, other: Any) -> bool:
    """Whether two settings are equal; a table has NaN where one is null."""
    return one == other or (other is None and one != one)


def best(points: pd.DataFrame) -> pd.Series:
    """Of `points` (see `chosen`) the one with the smallest assured error."""
    return points.dropna(subset=["error"]).sort_values(["assured", "cpu_seconds"]).iloc[0]


def verdict(choice: Choice) -> str:
    """Whether finer resolutions confirm a choice, in a sentence."""
    if choice.confirmed and choice.confirming is not None:
        text = f"confirmed: n={choice.confirming['n']} and all finer ones lie within as well"
        text += ", though the sign changes" if choice.row["turns"] else ""
    elif choice.row["lucky"]:
        text = "lucky, not to be relied on: a finer resolution with the same settings is farther off"
    else:
        text = "not confirmed: there is no finer resolution with the same settings"
    if choice.luckier is not None:
        error = percent(choice.luckier["error"], 2, sign=True)
        text += f"\na cheaper point is within ({error}), but less to be relied on"
    return text


def evidence(choice: Choice) -> Iterator[tuple[str, pd.Series]]:
    """The points that a choice rests on, each with its role."""
    for role, row in (
        ("best of cheaper ones", choice.failed),
        ("cheaper, but", choice.luckier),
        ("advised", choice.row),
        ("next finer", choice.confirming),
    ):
        if row is not None:
            yield role, row


def extrapolation(points: pd.DataFrame) -> tuple[Extrapolation, pd.DataFrame] | None:
    """The errors at zero particle spacing of the series that comes closest to zero error.

    Parameters
    ----------
    points : pandas.DataFrame
        As `chosen` returns it.

    Returns
    -------
    Extrapolation, pandas.DataFrame
        Value and uncertainty, as shares, and the FINEST points that they rest on, coarsest first. None if
        no series of three resolutions converges.
    """
    found = []
    for _, rows in points.dropna(subset=["error"]).sort_values("n").groupby("series"):
        finest = rows.iloc[-FINEST:]
        limit = _limit(finest["spacing"].tolist(), finest["error"].tolist())
        if math.isfinite(limit.value) and not limit.flag:
            found.append((limit, finest))
    return min(found, key=lambda one: abs(one[0].value) + one[0].uncertainty, default=None)


def _limit(spacings: list[float], errors: list[float]) -> Extrapolation:
    observed = extrapolate(spacings, errors)
    whole = max(1.0, round(observed.order)) if math.isfinite(observed.order) else math.nan
    return extrapolate(spacings, errors, whole) if abs(observed.order - whole) <= WHOLE else observed
