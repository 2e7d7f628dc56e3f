"""Tables on the console."""

import xarray as xr
from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy.analysis.cells import Cell, cells, shown
from sphstudy.catalogue import headline
from sphstudy.console import console
from sphstudy.text import number

LONGEST = 400
"""Rows of a table that are printed; of more points, only those that are not done."""


def print_tables(dataset: xr.Dataset) -> None:
    """A line a point with outcome, headline metrics and cost; a table for each scene, and for each solver
    with a headline of its own. Of very many points only those that are not done.
    """
    groups: dict[tuple, list[Cell]] = {}
    points = int((dataset["configuration"] != "").sum())
    listed = cells(dataset, without="done" if points > LONGEST else "")
    for cell in listed[:LONGEST]:
        shown_first = headline(cell.flat["scene"], cell.flat["solve"])
        groups.setdefault((cell.flat["scene"], shown_first), []).append(cell)
    for (_, shown_first), found in groups.items():
        _print_table(dataset, found, shown_first)
    if (more := points - sum(map(len, groups.values()))) > 0:
        print(f"{more} more points are not listed")


def _print_table(dataset: xr.Dataset, found: list[Cell], shown_first: tuple[str, ...]) -> None:
    columns = [n for n in (*shown_first, "cpu_seconds", "steps", "particles") if n in dataset]
    swept = list(found[0].place)
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for name in (*swept, "status", *columns):
        units = dataset[name].attrs.get("units", "1") if name in columns else "1"
        heading = name.replace("_", " ")
        table.add_column(heading if units == "1" else f"{heading} ({units})", justify="right")
    for cell in sorted(found, key=_order):
        place = [shown(value) for value in cell.place.values()]
        table.add_row(*place, cell.status, *(number(cell.values[c]) for c in columns))
    console().print(table)


def _order(cell: Cell) -> tuple:
    """Sorts points by their coordinates: text before numbers, each in its own order."""
    return tuple((0, v) if isinstance(v, str) else (1, v) for v in cell.place.values())
