"""The terminal, or what stands in its place where output goes to a file or a pipe."""

import codecs
import sys
import unicodedata

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table as Grid

from sphstudy.table import Table

LONGEST = 400
"""Rows of a list of runs that are printed; of more, only those that are not done."""


_PLAIN = dict(zip("−–×·─│≤≥∞→", ("-", "-", "x", "*", "-", "|", "<=", ">=", "inf", "->"), strict=True))
"""What is written for characters that a terminal does not have; others: see `_plain`."""


def _plain(error: UnicodeError) -> tuple[str, int]:
    """ASCII in place of characters that an encoding does not have, for `codecs.register_error`."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_spelled, error.object[error.start : error.end])), error.end


def _spelled(character: str) -> str:
    if character in _PLAIN:
        return _PLAIN[character]
    name = unicodedata.name(character, "")
    if name.startswith("GREEK"):
        return name.split()[-1].lower()
    return unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode() or "?"


codecs.register_error("sphstudy.plain", _plain)


def write_what_the_terminal_has() -> None:
    """Lets output and messages of this process go on where their encoding lacks a character."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="sphstudy.plain")


def console() -> Console:
    """The terminal, or something wide enough for any table. Text in brackets is text, not markup."""
    there = Console(markup=False)
    return there if there.is_terminal else Console(width=400, markup=False)


def print_table(table: Table) -> None:
    """Prints a table: numbers to the right, text folded where the terminal is narrow.

    Parameters
    ----------
    table : Table
        What is printed; its caption is the title, and a table without rows prints nothing.
    """
    if not table.rows:
        return
    grid = Grid(box=SIMPLE_HEAD, pad_edge=False, title=table.caption or None, title_justify="left")
    for column in table.columns:
        grid.add_column(column.title, justify="right" if column.numeric else "left", overflow="fold")
    for row in table.rows:
        grid.add_row(*(cell.text for cell in row))
    console().print(grid)
