"""Metrics at zero particle spacing, with uncertainty.

    sphstudy extrapolate STUDY|FILE.nc METRIC ... [options]

Richardson extrapolation of what was swept over n: v0 of v0 + c Δ^p. With
--order two resolutions are enough; without it p is observed, from three.

    sphstudy extrapolate mode1 G2_error --order 1
    sphstudy extrapolate tl_mode1 K_I_integral_error J_error --output zero.nc
"""

import math
import os
from pathlib import Path

import xarray as xr

from sphstudy.analysis.cells import shown
from sphstudy.analysis.extrapolation import Series, extrapolated_together, series
from sphstudy.analysis.richardson import ORDERS
from sphstudy.commands.parser import Request
from sphstudy.configuration import study_file
from sphstudy.console import print_table
from sphstudy.errors import ConfigurationError
from sphstudy.store.netcdf import UNREADABLE, read_dataset, write
from sphstudy.store.store import summarised
from sphstudy.table import Column, Table
from sphstudy.text import NOTHING, with_uncertainty


def run(request: Request) -> int:
    """Prints a table a metric and scene; keeps the result with --output."""
    name, *metrics = dict.fromkeys(request.words)
    given = "order" in request.options
    order = request.number("order", math.nan, *ORDERS) if given else None
    dataset = _dataset(name, request.results)
    output = Path(request.options["output"]) if "output" in request.options else None
    if output:
        _refuse_what_is_there(output, Path(dataset.encoding["source"]), request.has("overwrite"))
    try:
        found = {metric: series(dataset, metric, order) for metric in metrics}
    except ConfigurationError as error:
        raise ConfigurationError([f"{name}: {complaint}" for complaint in error.complaints]) from None
    for metric in metrics:
        _print(dataset[metric], found[metric])
    print("v0 of v0 + c Δ^p in the particle spacing Δ, p " + ("given" if given else "observed"))
    if output:
        try:
            write(extrapolated_together(dataset, metrics, order), output)
        except OSError as error:
            reason = error.strerror or error
            raise ConfigurationError([f"--output={output}: cannot be written ({reason})"]) from None
        print(f"dataset: {output}")
    return 0


def _refuse_what_is_there(output: Path, source: Path, overwrite: bool) -> None:
    """Raises ConfigurationError if the file may not be written."""
    if output.resolve() == source.resolve():
        raise ConfigurationError([f"--output={output}: that is the dataset itself"])
    if not os.path.lexists(output):
        return
    if not overwrite:
        raise ConfigurationError([f"--output={output}: is there already; --overwrite replaces it"])
    try:
        summarised(output)
    except UNREADABLE:
        return
    raise ConfigurationError([f"--output={output}: is the record of a run, which is not replaced"])


def _dataset(name: str, results: str) -> xr.Dataset:
    try:
        return read_dataset(name, results)
    except ConfigurationError as error:
        if name.endswith(".nc") or Path(name).exists():
            raise
        known = study_file.names()
        hint = f"run study {name} first" if name in known else f"studies are {', '.join(known)}"
        raise ConfigurationError([*error.complaints, f"{name}: {hint}"]) from None


def _print(metric: xr.DataArray, found: list[Series]) -> None:
    """A table a scene: a line a series. Scenes of which no point has the metric are left out."""
    units, meaning = metric.attrs["units"], metric.attrs["long_name"]
    print(f"{metric.name}: {meaning}" + ("" if units == "1" else f" ({units})"))
    measured = [s.scene for s in found if not all(map(math.isnan, s.values.values()))]
    for scene in dict.fromkeys(measured):
        own = [s for s in found if s.scene == scene]
        resolutions = sorted({n for s in own for n in s.values})
        headings = (*own[0].place, *(f"n={n}" for n in resolutions), "extrapolated", "order")
        rows = [
            [
                *map(shown, s.place.values()),
                *(_number(s.values.get(n, math.nan), ".6g") for n in resolutions),
                with_uncertainty(s.extrapolation.value, s.extrapolation.uncertainty),
                _number(s.extrapolation.order, ".3g"),
                s.extrapolation.flag,
            ]
            for s in own
        ]
        print_table(Table.of_texts([*map(Column, headings), Column("remark", numeric=False)], rows))
    if not measured:
        print("no point has it\n")


def _number(value: float, form: str) -> str:
    # Digits as in with_uncertainty, with which they are compared.
    return NOTHING if math.isnan(value) else format(value, form)
