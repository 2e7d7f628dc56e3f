"""Files in a folder of runs that serve nobody any more: which, why, and their size."""

import json
import shutil
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sphstudy.configuration.run_settings import validate
from sphstudy.errors import ConfigurationError
from sphstudy.store import identity
from sphstudy.store.adoption import adoptable
from sphstudy.store.atomic import UNFINISHED
from sphstudy.store.lock import is_alive
from sphstudy.store.store import CHECKPOINT, CLAIM, Store, read_summary

FORGOTTEN = 30 * 24 * 3600.0
"""Age of a checkpoint (s) from which on it counts as abandoned."""

RULES = """\
A record is stale when no run would be looked for under its name again: because
the numbers that its scene, method or solver computes have changed since (its
numerics version is not today's), or because a setting was added, renamed or
removed. A change of metrics makes no record stale. Beside records these are
stale: files set aside as unreadable, claims whose process is gone, logs without
a record, unfinished writes, and checkpoints a month old. Records of runs that
failed or timed out are kept: retry= runs them again."""


@dataclass(frozen=True)
class Stale:
    """A file that could go, why, and its size (bytes)."""

    path: Path
    reason: str
    size: int


def stale(store: Store) -> Iterator[Stale]:
    """Every file in the folder of runs that could go.

    Parameters
    ----------
    store : Store
        Its folder of runs is there.
    """
    stems = set()
    for path in store.files():
        reason = _why(store, path)
        if reason:
            yield Stale(path, reason, path.stat().st_size)
        else:
            stems.add(path.stem)
    alive = {path.name.removesuffix(CLAIM) for path in store.files(CLAIM) if is_alive(path)}
    for suffix, reason in (
        (CLAIM, "a claim whose process is gone"),
        (".log", "a log of a run without a record"),
    ):
        for path in store.files(suffix):
            stem = path.name.removesuffix(suffix)
            # A claim beside a record: its process was killed between the two.
            if stem not in alive and (suffix == CLAIM or stem not in stems):
                yield Stale(path, reason, path.stat().st_size)
    # Whoever was interrupted, failed or timed out goes on from it: only age says that nobody will.
    for path in store.files(CHECKPOINT):
        found = path.stat()
        if path.stem not in alive and time.time() - found.st_mtime > FORGOTTEN:
            yield Stale(path, "a checkpoint that nobody went on from for a month", found.st_size)
    for path in store.files(".unreadable"):
        yield Stale(path, "no record: set aside when it was looked for", path.lstat().st_size)
    for path in sorted(store.runs.glob(".index.sqlite*")):
        yield Stale(path, "an index that earlier versions kept", path.stat().st_size)
    if not alive:
        for path in sorted(store.runs.glob(f"{UNFINISHED}*")):
            yield Stale(path, "a write that was not finished", path.stat().st_size)


def remove(path: Path) -> None:
    """Removes a stale file, or a folder that lies where a record should."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _why(store: Store, path: Path) -> str:
    """Why a record is stale; "" if it is not."""
    summary = read_summary(path)
    if summary is None or adoptable(summary.attributes):
        return ""  # set aside just now, and listed as such; or `sphstudy adopt` makes use of it
    try:
        config = validate(json.loads(summary.attributes["configuration"]))
    except ConfigurationError as error:
        return f"not valid any more: {error.complaints[0]}"
    except (KeyError, ValueError, TypeError):
        return "not valid any more"
    if summary.attributes["numerics_version"] != identity.numerics_version(config):
        return "changed numerics: the code of scene, method or solver"
    return "" if store.record_path(config) == path else "another name today"
