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

    @classmethod
    def of_texts(cls, columns: list[Column], rows: list[list[str]], caption: str = "") -> "Table":
        """A table of plain texts.

        Parameters
        ----------
        columns : list of Column
            Headings.
        rows : list of list of str
            What stands in the cells.
        caption : str
            The title.
        """
        return cls(caption, columns, [[Cell(text) for text in row] for row in rows])
