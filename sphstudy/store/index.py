"""Summaries of records in one small database, so that a folder of 20 000 need not be opened file by file.

A cache and no more: an entry counts only for the very file that it was made from, by time and size, and a
database that is damaged, locked or not writable is done without.
"""

import sqlite3
from contextlib import closing, suppress
from pathlib import Path

from sphstudy.store.summary import Summary, of_text

BATCH = 200
"""New entries after which they are written."""

_TABLE = "CREATE TABLE IF NOT EXISTS records (name TEXT PRIMARY KEY, stamp TEXT, summary TEXT)"


class Index:
    """The summaries known of a folder, read when first asked for."""

    def __init__(self, path: Path):
        self.path = path
        # Texts become summaries when they are asked for: several times, in a study.
        self._known: dict[str, tuple[str, str | Summary]] | None = None
        self._new: dict[str, tuple[str, str]] = {}

    def get(self, name: str, stamp: tuple[int, int]) -> Summary | None:
        """The summary of a file of this name, written at that time and so large; None if unknown."""
        if self._known is None:
            self._known = self._read()
        seen, found = self._known.get(name, ("", ""))
        if seen != _text(stamp):
            return None
        if isinstance(found, str):
            try:
                found = of_text(found)
            except ValueError:
                return None
            self._known[name] = seen, found
        return found

    def put(self, name: str, stamp: tuple[int, int], summary: Summary) -> None:
        """Keeps a summary, in the file too before long."""
        if self._known is not None:
            self._known[name] = _text(stamp), summary
        self._new[name] = _text(stamp), summary.text
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

    def _read(self) -> dict[str, tuple[str, str | Summary]]:
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
