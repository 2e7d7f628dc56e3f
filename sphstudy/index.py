"""Summaries of records in one small database, so that a folder of 20 000 need not be opened file by file.

A cache and no more: an entry counts only for the very file that it was made from, by time and size, and a
database that is damaged, locked or not writable is done without.
"""

import json
import sqlite3
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

BATCH = 200
"""New entries after which they are written."""

_TABLE = "CREATE TABLE IF NOT EXISTS records (name TEXT PRIMARY KEY, stamp TEXT, summary TEXT)"


@dataclass(frozen=True)
class Summary:
    """A record without its fields: outcome, global attributes, and each metric and cost with its own."""

    status: str
    attributes: dict[str, Any]
    numbers: dict[str, tuple[float, dict[str, Any]]]


def plain(value: Any) -> Any:
    """An attribute of a netCDF file as JSON can keep it."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


class Index:
    """The summaries known of a folder, read when first asked for."""

    def __init__(self, path: Path):
        self.path = path
        self._known: dict[str, tuple[str, str]] | None = None
        self._new: dict[str, tuple[str, str]] = {}

    def get(self, name: str, stamp: tuple[int, int]) -> Summary | None:
        """The summary of a file of this name, written at that time and so large; None if unknown."""
        if self._known is None:
            self._known = self._read()
        seen, text = self._known.get(name, ("", ""))
        if seen != _text(stamp):
            return None
        try:
            status, attributes, numbers = json.loads(text)
            return Summary(status, attributes, {key: (v, own) for key, (v, own) in numbers.items()})
        except (ValueError, TypeError, AttributeError):
            return None

    def put(self, name: str, stamp: tuple[int, int], summary: Summary) -> None:
        """Keeps a summary, in the file too before long."""
        text = json.dumps([summary.status, summary.attributes, summary.numbers])
        entry = (_text(stamp), text)
        if self._known is not None:
            self._known[name] = entry
        self._new[name] = entry
        if len(self._new) >= BATCH:
            self.flush()

    def flush(self) -> None:
        """Writes what is new."""
        new, self._new = self._new, {}
        if not new:
            return
        with (
            suppress(sqlite3.Error, OSError),
            closing(sqlite3.connect(self.path, timeout=5.0)) as file,
            file,
        ):
            file.execute(_TABLE)
            rows = [(name, stamp, text) for name, (stamp, text) in new.items()]
            file.executemany("INSERT OR REPLACE INTO records VALUES (?, ?, ?)", rows)

    def _read(self) -> dict[str, tuple[str, str]]:
        if not self.path.exists():
            return {}
        try:
            with closing(sqlite3.connect(self.path, timeout=5.0)) as file:
                rows = file.execute("SELECT name, stamp, summary FROM records").fetchall()
            return {name: (stamp, text) for name, stamp, text in rows}
        except sqlite3.OperationalError:
            return {}  # locked, or without its table yet: done without for once
        except sqlite3.DatabaseError:
            with suppress(OSError):
                self.path.unlink(missing_ok=True)  # damaged: begun anew
            return {}


def _text(stamp: tuple[int, int]) -> str:
    return " ".join(map(str, stamp))
