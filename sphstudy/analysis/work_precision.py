"""Work and precision: which settings buy an error at the least CPU time, from points already computed.

An error may be small by luck: where it changes sign along n, some resolution hits zero whatever the
method is worth. So a point counts with its *assured* error, the largest of its own and of all finer
resolutions with everything else the same, and an error is *confirmed* to be within a bound where at
least one finer resolution is too.
"""

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from sphstudy.analysis.dimensions import hashable
from sphstudy.errors import ConfigurationError

ERRORS = {
    "plate": "frequency_error_2d",
    "bending": "bending_energy_error",
    "mode1": "K_I_integral_error",
    "mode2": "K_II_integral_error",
}
"""For each scene the relative error that its points are judged by: against two-dimensional elasticity,
or against the exact stress intensity.
"""

BOUNDS = (0.05, 0.01, 0.001, 0.0001)
"""Errors that a price is asked for."""

CLEARLY = 1.1
"""An error is lucky if that of a finer resolution is larger by more than this factor."""

_CHOICES = ("scene", "method", "solve", "h", "n", "seed")


def points(table: pd.DataFrame, scene: str, metric: str | None = None) -> pd.DataFrame:
    """The points of a scene in the table of a study's results that have run, each record once.

    Beside the columns of the table: `error` (signed, NaN unless the run is done), `size` (its magnitude),
    `series` (number that points have in common that differ in n alone), `assured` (largest size among
    the point and all finer ones of its series), `finer` (how many of these there are), `lucky` (whether
    one of them is clearly larger than its own) and `turns` (whether the next finer has another sign).
    metric: the error, if not that of ERRORS. Raises ConfigurationError if the scene has no error of its
    own.
    """
    if metric is None and scene not in ERRORS:
        raise ConfigurationError([f"scene={scene}: add metric=NAME; known are {', '.join(ERRORS)}"])
    metric = metric or ERRORS[scene]
    found = table[table["scene"] == scene].drop_duplicates("record")
    if "cpu_seconds" in found:
        found = found.dropna(subset=["cpu_seconds"])
    else:
        found = found.iloc[:0].assign(cpu_seconds=np.nan)
    done = found["status"] == "done"
    error = found[metric].where(done) if metric in found else pd.Series(np.nan, found.index)
    found = found.assign(error=error, size=error.abs(), series=_series(found))
    return found.assign(**_assured(found)).sort_values("cpu_seconds", kind="stable")


def settings(columns: Iterable[str]) -> list[str]:
    """Those columns of a table that are settings of a run."""
    return [name for name in columns if name in _CHOICES or "." in name]


def label(row: pd.Series) -> str:
    """Method, solver, h, n and time step of a point, for people."""
    words = [f"{row['method']} {row['solve']}", f"h={row['h']:g}", f"n={row['n']}"]
    if row["solve"] == "explicit":
        key = {"frequency": "safety"}.get(row["solve.time_step"], "courant")
        words.append(f"{key}={row[f'solve.{key}']:g}")
    return ", ".join(words)


def _series(found: pd.DataFrame) -> pd.Series:
    """A number for each group of points that agree in all but n (and in what is recorded)."""
    # Protocols may tie settings to n; when fields are kept changes no number.
    keys = [c for c in settings(found) if c != "n" and not c.startswith("record.")]
    groups: dict[Hashable, int] = {}
    number = [
        groups.setdefault(tuple(map(hashable, values)), len(groups))
        for values in found[keys].itertuples(index=False)
    ]
    return pd.Series(number, found.index, dtype=int)


def _assured(found: pd.DataFrame) -> dict[str, pd.Series]:
    columns: dict[str, dict[Any, Any]] = {key: {} for key in ("assured", "finer", "lucky", "turns")}
    for _, chosen in found.dropna(subset=["error"]).groupby("series"):
        largest, finer, sign = 0.0, 0, 0.0
        for row, size, error in chosen.sort_values("n", ascending=False)[["size", "error"]].itertuples():
            largest = max(largest, size)
            columns["assured"][row] = largest
            columns["finer"][row] = finer
            columns["lucky"][row] = CLEARLY * size < largest
            columns["turns"][row] = sign * error < 0.0
            finer, sign = finer + 1, np.sign(error)
    return {
        "assured": pd.Series(columns["assured"], found.index, dtype=float),
        "finer": pd.Series(columns["finer"], found.index, dtype=float).fillna(0).astype(int),
        **{
            key: pd.Series(columns[key], found.index, dtype=object).fillna(False).astype(bool)
            for key in ("lucky", "turns")
        },
    }


def front(found: pd.DataFrame) -> pd.DataFrame:
    """The points that no cheaper one equals: the Pareto front of assured error over CPU time, cheapest
    first. Of a series, the finest resolution has nothing that confirms it and stays out.
    """
    kept, best = [], np.inf
    candidates = found[found["finer"] > 0].dropna(subset=["assured"]).sort_values("cpu_seconds")
    for row, assured in candidates["assured"].items():
        if assured < best:
            best = assured
            kept.append(row)
    return found.loc[kept]


@dataclass(frozen=True)
class Choice:
    """The cheapest point whose error is within a bound, and whether a finer one confirms it.

    row: of the points. failed: the best, by assured error, of the cheaper points that miss the bound, and
    confirming: the next finer of its series, both None if there are none. luckier: the cheapest point
    within the bound if it is cheaper than this, but less to be relied on.
    """

    row: pd.Series
    confirmed: bool
    failed: pd.Series | None
    confirming: pd.Series | None
    luckier: pd.Series | None


def cheapest(found: pd.DataFrame, bound: float) -> Choice | None:
    """The cheapest of these points (see `points`) with an error within the bound.

    Confirmed ones whose sign does not change at the next finer one go first, then other confirmed ones,
    then those that nothing confirms, last those that a finer one contradicts. None if there are none.
    """
    within = found[found["size"] <= bound]
    honest = within[within["assured"] <= bound]
    confirmed = honest[honest["finer"] > 0]
    steady = confirmed[~confirmed["turns"]]
    best = next((one for one in (steady, confirmed, honest, within) if not one.empty), None)
    if best is None:
        return None
    row = best.iloc[0]
    cheaper = found[found["cpu_seconds"] < row["cpu_seconds"]]
    missing = cheaper[cheaper["size"] > bound]
    luckier = cheaper[cheaper["size"] <= bound]
    finer = found[(found["series"] == row["series"]) & (found["n"] > row["n"])].dropna(subset=["error"])
    return Choice(
        row,
        not confirmed.empty,
        None if missing.empty else missing.sort_values("assured").iloc[0],
        None if finer.empty else finer.sort_values("n").iloc[0],
        None if luckier.empty else luckier.iloc[0],
    )
