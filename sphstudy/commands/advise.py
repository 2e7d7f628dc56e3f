"""The command advise: the cheapest setting for an error, from stored points, and what it rests on."""

import math
import shlex
from collections.abc import Iterator
from typing import Any

import pandas as pd
import xarray as xr
from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy.analysis import work_precision
from sphstudy.analysis.cells import cells
from sphstudy.analysis.cost_forecast import prospect, rates
from sphstudy.analysis.richardson import Extrapolation, extrapolate
from sphstudy.analysis.work_precision import Choice
from sphstudy.commands.extrapolate import with_uncertainty
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Session, session
from sphstudy.console import console
from sphstudy.errors import ConfigurationError
from sphstudy.store.netcdf import read_dataset
from sphstudy.store.store import Store
from sphstudy.text import number, setting

_FILTERS = ("method", "solve")
_OPTIONS = ("scene", "error", "study", "metric", "results", *_FILTERS)
_USAGE = "advise scene=NAME error=0.1% [study=NAME] [method=NAME] [solve=NAME] [metric=NAME]"

FINEST = 3
"""Resolutions that an extrapolation rests on."""

WHOLE = 0.2
"""An order observed no farther than this from a whole number is taken for that number."""


def advise_command(arguments: list[str]) -> int:
    """`sphstudy advise scene=plate error=0.1%`: what to run, at what price, and why.

    Returns 0 if a point of the study reaches the error, else 1. Raises ConfigurationError on wrong input,
    and if no point of the scene is stored.
    """
    options = _parsed(arguments)
    bound, name = _bound(options["error"]), options.get("study", "precision")
    folder = options.get("results", "results")
    dataset = _stored(name, folder)
    points = _chosen(table(dataset), options, name)
    with session() as hydra:
        advice = _Advice(name, dataset, hydra, Store(folder), points)
        return advice.give(bound, options["scene"], options.get("metric"))


def _stored(name: str, folder: str) -> xr.Dataset:
    study_file.load(name)
    try:
        return read_dataset(name, folder)
    except ConfigurationError as error:
        raise ConfigurationError([f"{error}; run study {name} first"]) from None


def table(dataset: xr.Dataset) -> pd.DataFrame:
    """The points of a combined dataset as `precision.points` takes them: a row with settings, outcome,
    record, metrics and cost of each.
    """
    return pd.DataFrame(
        [
            {**cell.flat, **cell.values, "status": cell.status, "record": k}
            for k, cell in enumerate(cells(dataset))
        ]
    )


def _parsed(arguments: list[str]) -> dict[str, str]:
    options: dict[str, str] = {}
    for argument in arguments:
        key, _, value = argument.partition("=")
        if key not in _OPTIONS or not value:
            raise ConfigurationError([f"{argument}: not an option of advise; write {_USAGE}"])
        if key in options:
            raise ConfigurationError([f"{key}: is given twice"])
        options[key] = value
    if missing := [key for key in ("scene", "error") if key not in options]:
        raise ConfigurationError([f"advise: {' and '.join(missing)} lacking; write {_USAGE}"])
    return options


def _bound(text: str) -> float:
    """A relative error, written 0.001 or 0.1%."""
    try:
        value = float(text.removesuffix("%")) / (100.0 if text.endswith("%") else 1.0)
        if 0.0 < value < math.inf:
            return value
    except ValueError:
        pass
    raise ConfigurationError([f"error={text}: should be a positive number, as 0.001 or 0.1%"])


def _chosen(found: pd.DataFrame, options: dict[str, str], name: str) -> pd.DataFrame:
    """The points that are asked for and have run."""
    for key in ("scene", *_FILTERS):
        there = list(dict.fromkeys(found[key]))
        if key in options and options[key] not in there:
            raise ConfigurationError([f"{key}={options[key]}: in study {name} is {', '.join(there)}"])
        found = found[found[key] == options[key]] if key in options else found
    points = work_precision.points(found, options["scene"], options.get("metric"))
    where = " ".join(f"{key}={options[key]}" for key in ("scene", "metric", *_FILTERS) if key in options)
    if points["error"].isna().all():
        raise ConfigurationError([f"{where}: study {name} has no point of it that is done"])
    return points


class _Advice:
    """What is known: the points of a scene, what runs cost, and how to write a point's command."""

    def __init__(
        self, name: str, dataset: xr.Dataset, hydra: Session, store: Store, points: pd.DataFrame
    ):
        self.name, self.dataset, self.hydra, self.points = name, dataset, hydra, points
        self.store, self.known = store, rates(store)

    def give(self, bound: float, scene: str, metric: str | None) -> int:
        """Prints the advice; 0 if a point reaches the error, else 1."""
        metric = metric or work_precision.ERRORS[scene]
        print(f"{scene}: {metric} within {_percent(bound)} ({self.dataset[metric].attrs['long_name']})\n")
        choice = work_precision.cheapest(self.points, bound)
        if choice is None:
            done = self.points.dropna(subset=["error"])
            best = done.sort_values(["assured", "cpu_seconds"]).iloc[0]
            print("no point reaches it; the best, by its own error and those of all finer ones:\n")
            print(self._told(best))
        else:
            print(f"{self._told(choice.row)}\n{_verdict(choice)}")
            self._print(list(_evidence(choice)))
        if choice is None or not choice.confirmed or choice.row["turns"]:
            self._extrapolate(bound, metric)
        self._compilation()
        return 1 if choice is None else 0

    def _told(self, row: pd.Series) -> str:
        words = command(row, self.hydra)
        config = self.hydra.points(shlex.split(words)[1:], sweep=False)[0][0].config
        own = self.store.record_path(config).name
        predicted = self.known.seconds(config, prospect(config)[0], without=own)
        return (
            f"  {words}\n\n"
            f"error {_percent(row['error'], '+')}, {_seconds(row['cpu_seconds'])} of CPU time measured, "
            f"{_seconds(predicted)} predicted from other runs"
        )

    def _print(self, rows: list[tuple[str, pd.Series]]) -> None:
        """The points in a table, with the settings in which they differ from the defaults."""
        table = Table(box=SIMPLE_HEAD, pad_edge=False)
        for heading in ("", "error", "assured", "CPU (s)", "outcome"):
            table.add_column(heading, justify="right" if heading else "left")
        table.add_column("point", overflow="fold")
        for role, row in rows:
            numbers = _percent(row["error"], "+"), _percent(row["assured"]), number(row["cpu_seconds"])
            words = command(row, self.hydra).removeprefix("sphstudy ")
            table.add_row(role, *numbers, row["status"], words)
        console().print(table)
        print("assured: the largest error of the point and of all finer ones with the same settings")

    def _extrapolate(self, bound: float, metric: str) -> None:
        """What Richardson extrapolation makes of the series that it makes most of, if of any."""
        limits = []
        for _, rows in self.points.dropna(subset=["error"]).sort_values("n").groupby("series"):
            limit = _limit(rows)
            if math.isfinite(limit.value) and not limit.flag:
                limits.append((abs(limit.value) + limit.uncertainty, limit, rows))
        if not limits:
            print(
                "Richardson extrapolation makes nothing of it: no series of three resolutions converges"
            )
            return
        size, limit, rows = min(limits, key=lambda one: one[0])
        print(
            self._extrapolated(limit, rows, "reaches it" if size <= bound else "does not reach it either")
        )
        print(f"(all series: sphstudy extrapolate {self.name} {metric})")

    def _extrapolated(self, limit: Extrapolation, rows: pd.DataFrame, verdict: str) -> str:
        rows = rows.iloc[-FINEST:]
        words = command(rows.iloc[0], self.hydra).split()
        which = " ".join(word for word in words[1:] if not word.startswith("n="))
        value = with_uncertainty(100.0 * limit.value, 100.0 * limit.uncertainty)
        sizes, seconds = ",".join(map(str, rows["n"])), rows["cpu_seconds"].sum()
        return (
            f"Richardson extrapolation {verdict}: {value} %, order {limit.order:.2g},\n"
            f"from {which} n={sizes}, {_seconds(seconds)} of CPU time together"
        )

    def _compilation(self) -> None:
        compiling = self.points.get("compile_seconds", pd.Series(dtype=float)).max()
        told = f"at most {_seconds(compiling)} in" if compiling > 0.0 else "all was compiled before"
        print(f"compiling, apart and once: {told} these runs")


def _limit(rows: pd.DataFrame) -> Extrapolation:
    """The errors of a series (coarsest first) at zero spacing, from the finest three."""
    spacings, errors = (rows[key].tolist()[-FINEST:] for key in ("spacing", "error"))
    observed = extrapolate(spacings, errors)
    whole = max(1.0, round(observed.order)) if math.isfinite(observed.order) else math.nan
    if abs(observed.order - whole) <= WHOLE:
        return extrapolate(spacings, errors, whole)
    return observed


def command(row: pd.Series, hydra: Session) -> str:
    """The command line that makes the run with the settings of a row."""
    flat = {key: row[key] for key in work_precision.settings(row.index)}
    chosen = [f"{key}={setting(flat[key])}" for key in ("scene", "method", "solve", "h", "n")]
    usual = hydra.points(chosen, sweep=False)[0][0].config.flat()
    changed = [
        f"{key}={setting(flat[key])}" for key, value in usual.items() if not _same(flat[key], value)
    ]
    return " ".join(["sphstudy", *map(shlex.quote, chosen + changed)])


def _same(one: Any, other: Any) -> bool:
    """Whether two settings are equal; a table has NaN where one is null."""
    return one == other or (other is None and one != one)


def _verdict(choice: Choice) -> str:
    if choice.confirmed and choice.confirming is not None:
        told = f"confirmed: n={choice.confirming['n']} and all finer ones lie within as well"
        told += ", though the sign changes" if choice.row["turns"] else ""
    elif choice.row["lucky"]:
        told = "lucky, not to be relied on: a finer resolution with the same settings is farther off"
    else:
        told = "not confirmed: there is no finer resolution with the same settings"
    if choice.luckier is not None:
        error = _percent(choice.luckier["error"], "+")
        told += f"\na cheaper point is within ({error}), but less to be relied on"
    return told


def _evidence(choice: Choice) -> Iterator[tuple[str, pd.Series]]:
    """The points that the advice rests on, and as what."""
    for role, row in (
        ("best of cheaper ones", choice.failed),
        ("cheaper, but", choice.luckier),
        ("advised", choice.row),
        ("next finer", choice.confirming),
    ):
        if row is not None:
            yield role, row


def _percent(value: float, sign: str = "") -> str:
    return "–" if math.isnan(value) else f"{100.0 * value:{sign}.2g} %"


def _seconds(value: float) -> str:
    return f"{value:.2g} s" if value < 10.0 else f"{value:.0f} s"
