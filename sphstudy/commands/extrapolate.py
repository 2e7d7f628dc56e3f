"""The command extrapolate: what metrics tend to as the particle spacing goes to zero, as tables."""

import math
from collections.abc import Sequence
from pathlib import Path

import xarray as xr
from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy.analysis.cells import shown
from sphstudy.analysis.extrapolation import Series, extrapolated, series
from sphstudy.analysis.richardson import ORDERS
from sphstudy.configuration import study_file
from sphstudy.console import console
from sphstudy.errors import ConfigurationError
from sphstudy.store.netcdf import read_dataset, write

_OPTIONS = ("--order", "--output", "results")
_USAGE = "extrapolate STUDY|FILE.nc METRIC … [--order P] [--output FILE.nc] [results=FOLDER]"


def extrapolate_command(arguments: list[str]) -> int:
    """`sphstudy extrapolate STUDY|FILE.nc METRIC … [--order P] [--output FILE.nc]`: a table a metric.

    Raises ConfigurationError on wrong input.
    """
    given, options = _parsed(arguments)
    if len(given) < 2:
        raise ConfigurationError([f"extrapolate: write {_USAGE}"])
    name, metrics = given[0], list(dict.fromkeys(given[1:]))
    order = _order(options["--order"]) if "--order" in options else None
    dataset = _dataset(name, options.get("results", "results"))
    output = Path(options["--output"]) if "--output" in options else None
    if output and output.resolve() == Path(dataset.encoding["source"]).resolve():
        raise ConfigurationError([f"--output={output}: that is the dataset itself"])
    try:
        found = {metric: series(dataset, metric, order) for metric in metrics}
    except ConfigurationError as error:
        raise ConfigurationError([f"{name}: {complaint}" for complaint in error.complaints]) from None
    for metric in metrics:
        _print(dataset, metric, found[metric])
    print("v0 of v0 + c Δ^p in the particle spacing Δ, p " + ("observed" if order is None else "given"))
    if output:
        result = xr.Dataset()
        for metric in metrics:
            one = extrapolated(dataset, metric, order)
            result = result.assign(one.data_vars).assign_attrs(one.attrs)
        try:
            write(result, output)
        except OSError as error:
            reason = error.strerror or error
            raise ConfigurationError([f"--output={output}: cannot be written ({reason})"]) from None
        print(f"dataset: {output}")
    return 0


def _parsed(arguments: list[str]) -> tuple[list[str], dict[str, str]]:
    """What is given by its place, and what by name: --order P or --order=P."""
    given: list[str] = []
    options: dict[str, str] = {}
    remaining = iter(arguments)
    for argument in remaining:
        key, equals, value = argument.partition("=")
        if key in _OPTIONS and (equals or key.startswith("-")):
            options[key] = value if equals else next(remaining, "")
            if not options[key]:
                raise ConfigurationError([f"{key}: lacks its value; write {_USAGE}"])
        elif argument.startswith("-"):
            raise ConfigurationError([f"{argument}: not a flag of extrapolate; write {_USAGE}"])
        else:
            given.append(argument)
    return given, options


def _order(text: str) -> float:
    try:
        if ORDERS[0] <= (order := float(text)) <= ORDERS[1]:
            return order
    except ValueError:
        pass
    raise ConfigurationError(["--order={}: should be a number from {:g} to {:g}".format(text, *ORDERS)])


def _dataset(name: str, results: str) -> xr.Dataset:
    try:
        return read_dataset(name, results)
    except ConfigurationError as error:
        if name.endswith(".nc") or Path(name).exists():
            raise
        known = name in study_file.names()
        hint = f"run study {name} first" if known else f"studies are {', '.join(study_file.names())}"
        raise ConfigurationError([*error.complaints, f"{name}: {hint}"]) from None


def _print(dataset: xr.Dataset, metric: str, found: Sequence[Series]) -> None:
    """A table a scene: a line a series. Scenes of which no point has the metric are left out."""
    units, meaning = dataset[metric].attrs["units"], dataset[metric].attrs["long_name"]
    print(f"{metric}: {meaning}" + ("" if units == "1" else f" ({units})"))
    measured = [s.scene for s in found if not all(map(math.isnan, s.values.values()))]
    for scene in dict.fromkeys(measured):
        own = [s for s in found if s.scene == scene]
        resolutions = sorted({n for s in own for n in s.values})
        table = Table(box=SIMPLE_HEAD, pad_edge=False)
        for heading in (*own[0].place, *(f"n={n}" for n in resolutions), "extrapolated", "order"):
            table.add_column(heading, justify="right")
        table.add_column("remark", overflow="fold")
        for s in own:
            limit = s.extrapolation
            table.add_row(
                *(shown(value) for value in s.place.values()),
                *(_number(s.values.get(n, math.nan), ".6g") for n in resolutions),
                with_uncertainty(limit.value, limit.uncertainty),
                _number(limit.order, ".3g"),
                limit.flag,
            )
        console().print(table)
    if not measured:
        print("no point has it\n")


def _number(value: float, form: str) -> str:
    return "–" if math.isnan(value) else format(value, form)


def with_uncertainty(value: float, uncertainty: float) -> str:
    """A value with as many digits as two of its uncertainty leave it; a dash where there is none."""
    if math.isnan(value):
        return "–"
    if not uncertainty > 0.0:
        return f"{value:.6g} ± {uncertainty:.2g}"
    # The first two digits as they come out rounded: 0.0996 is 0.10.
    digits = 1 - int(f"{uncertainty:.1e}".partition("e")[2])
    if digits > 6:
        most = max(abs(value), uncertainty)
        return f"{value:.{max(digits + math.floor(math.log10(most)), 1)}e} ± {uncertainty:.1e}"
    value, uncertainty = round(value, digits), round(uncertainty, digits)
    return f"{value:.{max(digits, 0)}f} ± {uncertainty:.{max(digits, 0)}f}"
