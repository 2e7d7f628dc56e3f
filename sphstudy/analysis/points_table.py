"""What the store holds of a list of runs: a row each with outcome, origin, metrics and cost."""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sphstudy.configuration.run_settings import RunConfig
from sphstudy.store import identity
from sphstudy.store.measured import measured
from sphstudy.store.store import Store, read
from sphstudy.store.summary import Summary, of_record
from sphstudy.text import counted

ORIGIN = (
    "message", "git_state", "date_created", "sphstudy_version", "python_version", "library_versions",
    "processor",
)  # fmt: skip
"""Global attributes of a record that tables carry too."""

_measured: dict[tuple[Path, int, str], Summary] = {}
"""Summaries with metrics of today's version, by record, time of writing and that version."""


@dataclass(frozen=True)
class PointsTable:
    """Stored runs as a table.

    Attributes
    ----------
    rows : list of dict
        For each run `status`, `record` (file name), ORIGIN (empty without a record), and every metric and
        cost that it has.
    attributes : dict
        Units, meaning and group of each metric and cost, by name.
    """

    rows: list[dict[str, Any]]
    attributes: dict[str, dict[str, Any]]


def points_table(
    configs: list[RunConfig],
    store: Store,
    study: str = "STUDY",
    known: list[Summary | None] | None = None,
) -> PointsTable:
    """The stored runs of these configurations, in their order; nothing is run, nothing written.

    Metrics of another version are measured in memory, which one line on stderr reports.

    Parameters
    ----------
    configs : list of RunConfig
        The runs.
    store : Store
        Where their records are.
    study : str
        The study that they belong to, for the line on stderr.
    known : list of Summary, optional
        Summaries of their records that have been read already; None for the others.
    """
    table, already = PointsTable([], {}), len(_measured)
    for config, read_before in zip(configs, known or [None] * len(configs), strict=True):
        path = store.record_path(config)
        summary = read_before or store.summary(config)
        if summary is not None and summary.status == "done":
            summary = _current(summary, path, config, store)
        row: dict[str, Any] = {
            "status": store.status(config) if summary is None else summary.status,
            "record": path.name,
            **{key: "" if summary is None else summary.attributes[key] for key in ORIGIN},
        }
        if summary is not None:
            row |= summary.numbers
            table.attributes.update(summary.described)
        table.rows.append(row)
    if (count := len(_measured) - already) > 0:
        print(
            f"metrics of an older version were measured anew, in memory, for {counted(count, 'record')}: "
            f"`sphstudy measure {study}` keeps them",
            file=sys.stderr,
        )
    return table


def _current(summary: Summary, path: Path, config: RunConfig, store: Store) -> Summary | None:
    """The summary with metrics of today's version; None if the record turns out to be damaged."""
    version = identity.metrics_version(config)
    if summary.attributes["metrics_version"] == version:
        return summary
    place = path, store.stamp(config), version
    if place not in _measured:
        if (run := read(path)) is None:
            return None
        _measured[place] = of_record(measured(run, config))
    return _measured[place]
