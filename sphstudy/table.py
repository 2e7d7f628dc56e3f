"""A table as data: it is written to the terminal (console.py) and to a page (report/page.html.jinja)."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Cell:
    """What stands in a cell. order: what it is sorted by, if not the text; badge: a status or verdict."""

    text: str
    order: float | None = None
    badge: bool = False


@dataclass(frozen=True)
class Column:
    """Heading, meaning, and whether numbers stand below it."""

    title: str
    meaning: str = ""
    numeric: bool = True


@dataclass(frozen=True)
class Table:
    """Columns and rows of cells, ready to be written out."""

    caption: str
    columns: list[Column]
    rows: list[list[Cell]]
