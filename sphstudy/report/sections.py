"""A study on the page of a report: figures, tables, points that are not done, origins of records."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from sphstudy import text
from sphstudy.analysis.effects import effects
from sphstudy.analysis.results import Results
from sphstudy.analysis.stability.cases import judged
from sphstudy.configuration import study_file
from sphstudy.report import cheapest, render, tables, time_steps
from sphstudy.report.render import Drawing
from sphstudy.report.stability_tables import bounds, quoted, stability_map
from sphstudy.report.tables import Group, Setting
from sphstudy.store.record import STATUS
from sphstudy.table import Table


@dataclass(frozen=True)
class GroupTables:
    """The tables of one scene in one block."""

    title: str
    summary: str
    points: Table
    effects: Table | None
    cost: Table | None
    settings: list[Setting]


@dataclass(frozen=True)
class NotDone:
    """A point without a result, and why."""

    label: str
    status: str
    message: str


@dataclass(frozen=True)
class Section:
    """A study on the page. stored: whether the store has any of its points (True without points).
    not_named: points that are not done and not listed.
    """

    name: str
    title: str
    summary: str
    stored: bool
    drawings: list[Drawing]
    groups: list[GroupTables]
    overviews: list[Table]
    judged: list[Table]
    not_done: list[NotDone]
    not_named: int


@dataclass(frozen=True)
class Origin:
    """What computed some of the records. dirty: sources with uncommitted changes."""

    records: int
    first: str
    last: str
    commit: str
    dirty: bool
    version: str
    libraries: str
    processor: str


def studies(results: Results) -> list[Results]:
    """The study, those that it includes and those that it shows, in the order of the page."""
    names = [results.name, *study_file.members(results.name), *results.definition.shows]
    return [results.other(name) for name in dict.fromkeys(names)]


def section(results: Results, folder: Path) -> Section:
    """Draws the study's figures into the folder and makes its tables."""
    rows = results.table[results.table["study"] == results.name]
    stored = bool((rows["status"] != "missing").any()) if len(rows) else True
    definition = results.definition
    undone = rows[rows["status"] != "done"]
    named = undone.head(tables.LONGEST)
    return Section(
        name=results.name,
        title=definition.title,
        summary=summary(rows),
        stored=stored,
        drawings=render.draw_all(results, folder) if stored else [],
        groups=[_tables(group) for group in tables.groups(results, rows)] if stored else [],
        overviews=[*cheapest.tables(results), *time_steps.tables(results)] if stored else [],
        judged=_judged(results) if stored and definition.judged else [],
        not_done=[_not_done(row) for _, row in named.iterrows()],
        not_named=len(undone) - len(named),
    )


def _judged(results: Results) -> list[Table]:
    cases = judged(results)
    found = (stability_map(cases), bounds(cases), quoted(results, cases))
    return [table for table in found if table is not None]


def _tables(group: Group) -> GroupTables:
    several = group.results.table.groupby("block")["scene"].nunique()[group.block] > 1
    found = [effect for effect in effects(group.results) if effect.block == group.block]
    return GroupTables(
        title=f"{group.block}, scene {group.scene}" if several else group.block,
        summary=_cost_summary(group.rows),
        points=tables.points(group),
        effects=tables.effects(group, found) if found else None,
        cost=tables.cost(group),
        settings=tables.common_settings(group),
    )


def _not_done(row: pd.Series) -> NotDone:
    varied = f", {row['varied']}" if row["varied"] else ""
    label = f"{row['block']}: {row['scene']} h={row['h']:g} n={row['n']}{varied}"
    return NotDone(label, row["status"], row["message"])


def summary(rows: pd.DataFrame) -> str:
    """The number of points by outcome and their CPU time, in words; each record counts once."""
    rows = rows.drop_duplicates("record")
    if rows.empty:
        return ""
    counts = Counter(rows["status"])
    outcomes = ", ".join(
        f"{counts[status]} {status}" for status in (*STATUS[1:], STATUS[0]) if counts[status]
    )
    seconds = text.duration(rows["cpu_seconds"].sum()) if "cpu_seconds" in rows else "0 s"
    return f"{text.counted(len(rows), 'point')}: {outcomes}; {seconds} of CPU time in all"


def _cost_summary(rows: pd.DataFrame) -> str:
    if "cpu_seconds" not in rows or (seconds := rows["cpu_seconds"].dropna()).empty:
        return "No point has been computed yet"
    least, most, total = (text.duration(s) for s in (seconds.min(), seconds.max(), seconds.sum()))
    if len(seconds) == 1:
        return f"1 point computed, {total} of CPU time"
    points = text.counted(len(seconds), "point")
    return f"{points} computed, {least} to {most} of CPU time each, {total} in all"


def origins(found: Iterable[Results]) -> list[Origin]:
    """The origins of all records of these studies, from their attributes."""
    tables = [results.table[results.table["status"] != "missing"] for results in found]
    records = pd.concat(tables).drop_duplicates("record")
    dates: dict[tuple[str, ...], list[str]] = {}
    for _, record in records.iterrows():
        libraries = f"Python {record['python_version']}, {record['library_versions']}"
        source = (record["git_state"], record["sphstudy_version"], libraries, record["processor"])
        dates.setdefault(source, []).append(record["date_created"])
    return [_origin(source, sorted(begun)) for source, begun in dates.items()]


def _origin(source: tuple[str, ...], begun: list[str]) -> Origin:
    state, *rest = source
    commit = state.removesuffix(" (dirty)")
    return Origin(len(begun), begun[0], begun[-1], commit, commit != state, *rest)
