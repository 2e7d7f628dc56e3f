"""The points of a dataset on the console, with their outcomes."""

from pathlib import Path

import xarray as xr

from sphstudy.analysis.cells import Cell, cells, shown
from sphstudy.catalogue import headline
from sphstudy.console import LONGEST, print_table
from sphstudy.store.record import STATUS
from sphstudy.table import Column, Table
from sphstudy.text import number

_UNDONE = ("missing", "interrupted", "running")


def print_outcome(dataset: xr.Dataset, path: Path) -> int:
    """Prints the points of a dataset, and what is to be done about those without a result.

    Parameters
    ----------
    dataset : xarray.Dataset
        A combined dataset.
    path : Path
        Its file.

    Returns
    -------
    int
        1 if a point failed, timed out or has no record, else 0.
    """
    print_tables(dataset)
    print(f"dataset: {path}")
    bad = {name: int((dataset["status"] == STATUS.index(name)).sum()) for name in ("failed", "timeout")}
    there = dataset["configuration"] != ""
    without = int((there & dataset["status"].isin([STATUS.index(name) for name in _UNDONE])).sum())
    for name, count in bad.items():
        if count:
            print(f"{count} {name}: the .log beside each record says more; retry={name} tries again")
    if without:
        print(f"{without} points have no record: repeat the command to run them")
    return 1 if without or any(bad.values()) else 0


def print_tables(dataset: xr.Dataset) -> None:
    """Prints a line a point with outcome, headline metrics and cost.

    Parameters
    ----------
    dataset : xarray.Dataset
        A combined dataset. There is a table for each scene, and for each solver with a headline of its
        own. Of more than LONGEST points only those that are not done are printed.
    """
    groups: dict[tuple, list[Cell]] = {}
    points = int((dataset["configuration"] != "").sum())
    listed = cells(dataset, without="done" if points > LONGEST else "")
    for point in listed[:LONGEST]:
        metrics = headline(point.flat["scene"], point.flat["solve"])
        groups.setdefault((point.flat["scene"], metrics), []).append(point)
    for (_, metrics), found in groups.items():
        print_table(_table(dataset, found, metrics))
    if (more := points - sum(map(len, groups.values()))) > 0:
        print(f"{more} more points are not listed")


def _table(dataset: xr.Dataset, points: list[Cell], metrics: tuple[str, ...]) -> Table:
    columns = [n for n in (*metrics, "cpu_seconds", "steps", "particles") if n in dataset]
    headings = [*points[0].place, "status", *(_heading(name, dataset[name]) for name in columns)]
    rows = [
        [*map(shown, point.place.values()), point.status, *(number(point.values[c]) for c in columns)]
        for point in sorted(points, key=_order)
    ]
    return Table.of_texts([Column(heading.replace("_", " ")) for heading in headings], rows)


def _heading(name: str, variable: xr.DataArray) -> str:
    units = variable.attrs.get("units", "1")
    return name if units == "1" else f"{name} ({units})"


def _order(point: Cell) -> tuple:
    """Sorts points by their coordinates: text before numbers, each in its own order."""
    return tuple((0, v) if isinstance(v, str) else (1, v) for v in point.place.values())
