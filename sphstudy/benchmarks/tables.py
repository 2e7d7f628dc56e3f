"""Datasets of the benchmarks as tables."""

from collections.abc import Sequence

import xarray as xr

from sphstudy import text
from sphstudy.table import Cell, Column, Table


def table(caption: str, found: xr.Dataset, dimension: str, names: Sequence[str]) -> Table:
    """Variables of a dataset as columns, a row for each place along a dimension.

    Parameters
    ----------
    caption : str
        Title of the table.
    found : xarray.Dataset
        The dataset.
    dimension : str
        The dimension; its labels, if it has any, are the first column. Without it the table is empty.
    names : sequence of str
        Variables, whose units are written in the headings.
    """
    if dimension not in found.dims:
        return Table(caption, [], [])
    every = [dimension, *names] if dimension in found.coords else list(names)
    units = {name: found[name].attrs.get("units", "1") for name in every}
    numeric = {name: found[name].dtype.kind in "biuf" for name in every}
    columns = [
        Column(text.heading(name, units[name]), found[name].attrs.get("long_name", ""), numeric[name])
        for name in every
    ]
    rows = [
        [
            Cell(text.metric(name, float(value), units[name]) if numeric[name] else str(value))
            for name, value in ((name, found[name].values[place]) for name in every)
        ]
        for place in range(found.sizes[dimension])
    ]
    return Table(caption, columns, rows)
