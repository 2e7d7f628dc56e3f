"""The cheapest setting for an error, from stored points.

    sphstudy advise scene=NAME error=E [options]

Answers from the stored points of a study: the command to run, its error and
CPU time, and the points that this rests on. Every option may be written
name=value. Exit status 1: no point reaches the error.

    sphstudy advise scene=plate error=0.1%     the same as error=0.001
    sphstudy advise scene=mode1 error=1% method=tl
"""

import math
import shlex

import pandas as pd
import xarray as xr

from sphstudy.analysis import advice, work_precision
from sphstudy.analysis.cost_forecast import prospect, rates
from sphstudy.commands.parser import Request
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Session, session
from sphstudy.console import print_table
from sphstudy.errors import ConfigurationError
from sphstudy.store.netcdf import read_dataset
from sphstudy.store.store import Store
from sphstudy.table import Column, Table
from sphstudy.text import duration, number, percent, with_uncertainty


def run(request: Request) -> int:
    """Prints what to run, at what price, and why; 1 if no point of the study reaches the error."""
    options = request.options
    if missing := [key for key in ("scene", "error") if key not in options]:
        raise ConfigurationError([f"advise: {' and '.join(missing)} lacking; {request.misused()}"])
    bound, name = _bound(options["error"]), options.get("study", "precision")
    dataset = _stored(name, request.results)
    wanted: dict[str, str] = {
        key: options[key] for key in ("scene", "metric", "method", "solve") if key in options
    }
    points = advice.chosen(advice.table(dataset), wanted, name)
    metric = options.get("metric") or work_precision.ERRORS[options["scene"]]
    meaning = dataset[metric].attrs["long_name"]
    print(f"{options['scene']}: {metric} within {percent(bound, 2)} ({meaning})\n")
    choice = work_precision.cheapest(points, bound)
    with session() as hydra:
        store = Store(request.results)
        if choice is None:
            print("no point reaches it; the best, by its own error and those of all finer ones:\n")
            _print_point(advice.best(points), hydra, store)
        else:
            _print_point(choice.row, hydra, store)
            print(advice.verdict(choice))
            _print_evidence(list(advice.evidence(choice)), hydra)
        if choice is None or not choice.confirmed or choice.row["turns"]:
            _print_extrapolation(points, bound, hydra)
            print(f"(all series: sphstudy extrapolate {name} {metric})")
    compiling = points.get("compile_seconds", pd.Series(dtype=float)).max()
    cost = f"at most {duration(compiling, 2)} in" if compiling > 0.0 else "all was compiled before"
    print(f"compiling, apart and once: {cost} these runs")
    return 1 if choice is None else 0


def _bound(text: str) -> float:
    """A relative error, written 0.001 or 0.1%."""
    try:
        value = float(text.removesuffix("%")) / (100.0 if text.endswith("%") else 1.0)
        if 0.0 < value < math.inf:
            return value
    except ValueError:
        pass
    raise ConfigurationError([f"error={text}: should be a positive number, as 0.001 or 0.1%"])


def _stored(name: str, folder: str) -> xr.Dataset:
    study_file.load(name)
    try:
        return read_dataset(name, folder)
    except ConfigurationError as error:
        raise ConfigurationError([f"{error}; run study {name} first"]) from None


def _print_point(row: pd.Series, hydra: Session, store: Store) -> None:
    words = advice.command(row, hydra)
    config = hydra.points(shlex.split(words)[1:], sweep=False)[0][0].config
    own = store.record_path(config).name
    predicted = rates(store).seconds(config, prospect(config)[0], without=own)
    print(
        f"  {words}\n\n"
        f"error {percent(row['error'], 2, sign=True)}, "
        f"{duration(row['cpu_seconds'], 2)} of CPU time measured, "
        f"{duration(predicted, 2)} predicted from other runs"
    )


def _print_evidence(rows: list[tuple[str, pd.Series]], hydra: Session) -> None:
    """The points in a table, with the settings in which they differ from the defaults."""
    columns = [Column("", numeric=False), *map(Column, ("error", "assured", "CPU (s)", "outcome"))]
    texts = []
    for role, row in rows:
        words = advice.command(row, hydra).removeprefix("sphstudy ")
        errors = percent(row["error"], 2, sign=True), percent(row["assured"], 2)
        texts.append([role, *errors, number(row["cpu_seconds"]), row["status"], words])
    print_table(Table.of_texts([*columns, Column("point", numeric=False)], texts))
    print("assured: the largest error of the point and of all finer ones with the same settings")


def _print_extrapolation(points: pd.DataFrame, bound: float, hydra: Session) -> None:
    found = advice.extrapolation(points)
    if found is None:
        print("Richardson extrapolation gives nothing: no series of three resolutions converges")
        return
    limit, rows = found
    reached = abs(limit.value) + limit.uncertainty <= bound
    value = with_uncertainty(100.0 * limit.value, 100.0 * limit.uncertainty)
    words = advice.command(rows.iloc[0], hydra).split()
    which = " ".join(word for word in words[1:] if not word.startswith("n="))
    print(
        f"Richardson extrapolation {'reaches it' if reached else 'does not reach it either'}: "
        f"{value} %, order {limit.order:.2g},\n"
        f"from {which} n={','.join(map(str, rows['n']))}, "
        f"{duration(rows['cpu_seconds'].sum(), 2)} of CPU time together"
    )
