"""What the results folder holds, or how far a study is.

    sphstudy status [options]
    sphstudy status STUDY [key=value ...] [options]

Lists runs with outcome, CPU time and progress. Of a study also: how many
points are done, how fast they come, and what is left.

    sphstudy status                            every run in results
    sphstudy status mode1                      the points of a study
"""

import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sphstudy.commands.parser import Request
from sphstudy.console import LONGEST, print_table
from sphstudy.errors import ConfigurationError
from sphstudy.store.lock import Holder, holder, is_alive
from sphstudy.store.store import CHECKPOINT, CLAIM, Store, read_summary
from sphstudy.table import Column, Table
from sphstudy.text import duration


@dataclass(frozen=True)
class Line:
    """A run: its name, outcome, CPU time (s; NaN if unknown) and a remark."""

    name: str
    outcome: str
    seconds: float
    note: str


def run(request: Request) -> int:
    """Lists runs with outcomes and counts; of a study also how fast its points come, and what is left."""
    if request.words:
        lines, left = _of_study(request)
    elif wrong := [one for one in request.settings if not one.startswith("results=")]:
        raise ConfigurationError([f"{one}: status takes settings with a study only" for one in wrong])
    else:
        lines, left = _of_folder(request.results), ""
    shown = lines if len(lines) <= LONGEST else [line for line in lines if line.outcome != "done"]
    columns = [
        Column(heading, numeric="(" in heading) for heading in ("run", "outcome", "CPU (s)", "note")
    ]
    rows = [
        [
            line.name,
            line.outcome,
            "" if line.seconds != line.seconds else f"{line.seconds:.1f}",
            line.note,
        ]
        for line in shown[:LONGEST]
    ]
    print_table(Table.of_texts(columns, rows))
    if len(rows) < len(lines):
        print(f"{len(lines) - len(rows)} more runs are not listed")
    counts = Counter(line.outcome for line in lines)
    print(", ".join(f"{count} {name}" for name, count in counts.items()) or "no runs")
    if left:
        print(left)
    return 0


def _of_folder(folder: str) -> list[Line]:
    store = Store(folder)
    if not store.runs.is_dir():
        raise ConfigurationError([f"results={folder}: there are no runs"])
    stems = {path.stem for path in store.files()}
    claimed = {path.name.removesuffix(CLAIM) for path in store.files(CLAIM)}
    kept = {path.stem for path in store.files(CHECKPOINT)}
    # Files that are set aside while they are read here are listed below.
    lines = [
        line
        for stem in sorted(stems | claimed | kept)
        if (line := _line(store, store.runs / stem, stem in claimed, stem in kept))
    ]
    lines += [
        Line(path.stem, "unreadable", float("nan"), "set aside; the run is done again when asked for")
        for path in store.files(".unreadable")
    ]
    return lines


def _line(store: Store, stem: Path, claimed: bool, kept: bool) -> Line | None:
    """A run with a claim, a checkpoint or a record; None if none of these can be read."""
    claim = stem.with_name(stem.name + CLAIM)
    alive = claimed and is_alive(claim)
    if not alive and (summary := read_summary(stem.with_name(stem.name + ".nc"))):
        # A claim that is lost beside a record: its process was killed when all was done.
        seconds = summary.numbers.get("cpu_seconds", float("nan"))
        return Line(stem.name, summary.status, seconds, summary.attributes["message"])
    if alive or claimed or kept:
        told = _whereabouts(holder(claim), alive) if claimed else "it goes on from its checkpoint"
        return Line(stem.name, "running" if alive else "interrupted", float("nan"), told)
    return None


def _whereabouts(note: Holder | None, alive: bool) -> str:
    """Where a run is computed, since when, and how far it is."""
    if note is None:
        return "its claim cannot be read"
    since = time.strftime("%Y-%m-%d %H:%M", time.localtime(note.started))
    where = f"process {note.process} on {note.host}, since {since}, {'alive' if alive else 'lost'}"
    return (f"step {note.step:,} of {note.steps:,}, " if note.steps else "") + where


def _of_study(request: Request) -> tuple[list[Line], str]:
    """The points of a study; how many are done, how fast, and how long the rest will take."""
    # A folder is listed without them, in half a second less.
    from sphstudy.configuration.composition import session
    from sphstudy.configuration.study_points import all_points
    from sphstudy.running.plan import plan

    with session(request.config_dir) as hydra:
        points, folder, _ = all_points(hydra, request.words[0], list(request.settings))
        store = Store(folder)
        planned = plan(points, store)
        lines = [_of_point(store, p.point.config, p.status) for p in planned]
    return lines, "\n".join(_pace(store, planned))


def _of_point(store: Store, config, status: str) -> Line:
    stem = store.record_path(config).with_suffix("")
    claimed, kept = store.claim_path(config).exists(), store.checkpoint_path(config).exists()
    line = None
    if claimed or kept or store.record_path(config).exists():
        line = _line(store, stem, claimed, kept)
    return line or Line(stem.name, status, float("nan"), "")


def _pace(store: Store, planned) -> Iterator[str]:
    """Points with a record over all, the rate at which they came, and what is left."""
    there = [p for p in planned if store.record_path(p.point.config).exists()]
    times = sorted(store.stamp(p.point.config) * 1e-9 for p in there)
    yield f"{len(there)} of {len(planned)} points have a record"
    recent = [t for t in times if times[-1] - t < 3600.0]
    if len(recent) > 1 and recent[-1] > recent[0]:
        rate = (len(recent) - 1) / (recent[-1] - recent[0]) * 3600.0
        yield f"{rate:.3g} an hour while the last {len(recent)} were made"
    left = [p for p in planned if p not in there]
    seconds = sum(p.seconds * (1.0 - _share_done(store, p.point.config)) for p in left)
    if left:
        yield f"{len(left)} left, about {duration(seconds, 2)} of CPU time"


def _share_done(store: Store, config) -> float:
    note = holder(store.claim_path(config))
    return note.step / note.steps if note and note.steps else 0.0
