"""Results made up: in a table, by altering others, or with records in a store."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pandas as pd

from sphstudy import catalogue
from sphstudy.analysis.results import Results, load
from sphstudy.configuration import study_file
from sphstudy.store.netcdf import write
from sphstudy.store.store import Store

COLUMNS = (
    "study", "block", "varied", "h", "n", "scene", "scene.H0", "scene.K", "method.kernel",
    "method.artificial_stress", "status", "message", "record", "git_state",
)  # fmt: skip

SMOOTHING = (1.3, 1.5, 1.7, 1.9)

Rows = list[dict[str, Any]]


def altered(found: Results, **changed: Any) -> Results:
    """The same results, but for some of what Results takes: table, record, other …"""
    own: dict[str, Any] = {
        "name": found.name,
        "definition": found.definition,
        "table": found.table.copy(),
        "attributes": found.attributes,
        "record": found.stored_at,
        "other": found.other,
        "config": found.config_at,
    }
    return Results(**(own | changed))


def stored(folder, monkeypatch, hydra, text: str, make: Callable, name: str = "made_up") -> Results:
    """Results of a study of this text, with the record of each point that `make(point, config)` gives.

    point: its row of the table. The study and its records lie in the folder.
    """
    (folder / f"{name}.yaml").write_text(text)
    monkeypatch.setitem(catalogue.FOLDERS, "studies", folder)
    store = Store(folder / "results")
    empty = load(name, hydra, [], str(store.folder))
    for row, point in empty.table.iterrows():
        config = empty.config_at(row)
        run = make(point, config)
        if run is not None:
            write(run, store.record_path(config))
    return load(name, hydra, [], str(store.folder))


def results(name: str, rows: Rows, scene: dict[str, Any] | None = None, **others: Results) -> Results:
    """Results of a study that exists, with these rows; studies not among `others` have no points.

    scene: what the configuration of every point says of it.
    """
    filled = [
        {"study": name, "block": "grid", "varied": "", "status": "done", "record": f"{k}.nc", **row}
        for k, row in enumerate(rows)
    ]
    table = pd.DataFrame(filled) if filled else pd.DataFrame(columns=list(COLUMNS))
    for column in COLUMNS:
        if column not in table:
            table[column] = None

    def config(row: int) -> Any:
        point = table.loc[row]
        return SimpleNamespace(h=point["h"], n=point["n"], scene=SimpleNamespace(**(scene or {})))

    def other(inner: str, overrides: list[str]) -> Results:
        assert not overrides
        return others.get(inner) or results(inner, [])

    return Results(name, study_file.load(name), table, {}, lambda row: None, other, config)


def grid(
    scene: str, resolutions: tuple[int, ...], **metrics: Callable[[float, int], float] | float
) -> Rows:
    """A row for each h̃ and n; a metric is a number or a function of the two."""
    return [
        {
            "scene": scene,
            "h": h,
            "n": n,
            **{name: value(h, n) if callable(value) else value for name, value in metrics.items()},
        }
        for h in SMOOTHING
        for n in resolutions
    ]


def change(rows: Rows, h: float, n: int, **metrics: float) -> Rows:
    """The rows with other values in one cell."""
    return [row | metrics if (row["h"], row["n"]) == (h, n) else row for row in rows]


def every(rows: Rows, **metrics: Callable[[float, int], float]) -> Rows:
    """The rows with these metrics replaced in all cells."""
    return [row | {name: value(row["h"], row["n"]) for name, value in metrics.items()} for row in rows]
