"""Tables on the console."""

import numpy as np
import xarray as xr
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from sphstudy.cells import Cell, cells, shown
from sphstudy.config import scene_module


def console() -> Console:
    """The terminal, or something wide enough for any table. Text in brackets is text, not markup."""
    there = Console(markup=False)
    return there if there.is_terminal else Console(width=400, markup=False)


def print_tables(dataset: xr.Dataset) -> None:
    """One table a scene: a line a point with outcome, the scene's headline metrics, and cost."""
    found = cells(dataset)
    for scene in dict.fromkeys(cell.flat["scene"] for cell in found):
        _print_table(dataset, [cell for cell in found if cell.flat["scene"] == scene])


def _print_table(dataset: xr.Dataset, found: list[Cell]) -> None:
    headline = scene_module(found[0].flat["scene.kind"]).HEADLINE
    columns = [n for n in (*headline, "cpu_seconds", "steps", "particles") if n in dataset]
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


def number(value: float) -> str:
    """Four significant digits; a dash where there is no number."""
    if np.isnan(value):
        return "–"
    if value == int(value) and abs(value) < 1e15:
        return f"{int(value)}"
    return f"{value:.4g}"
