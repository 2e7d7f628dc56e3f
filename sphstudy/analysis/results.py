"""What the store holds of a study: a table of all points and their records. Reads, never runs."""

from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any

import pandas as pd
import xarray as xr

from sphstudy.analysis.points_table import points_table
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Session
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.configuration.study_file import Study
from sphstudy.configuration.study_points import StudyPoints, all_points
from sphstudy.store.measured import up_to_date
from sphstudy.store.store import Store


class Missing(LookupError):
    """Something asked for is not in the store: the message says what and why."""


class Results:
    """The stored points of a study.

    table: a row for each point of each block, in order. Its columns: `study`, the member that the point
    belongs to (the study itself or one that it includes); `block`; `varied` ("key=value" in a block
    that varies settings one at a time, else ""); every setting of the flat configuration ("h", "n",
    "scene", "scene.E", ...); `status`, `record` (file name) and where it comes from (collect.ORIGIN:
    `message`, `git_state`, ...); and every metric and cost (NaN where there is none). attributes: units
    and long_name of each metric and cost.
    """

    def __init__(
        self,
        name: str,
        definition: Study,
        table: pd.DataFrame,
        attributes: dict[str, dict[str, Any]],
        record: Callable[[int], xr.Dataset | None],
        other: Callable[[str, list[str]], "Results"],
        config: Callable[[int], RunConfig],
    ):
        """`record` and `config` take a row's index in the table, `other` a study's name and overrides."""
        self.name, self.definition, self.table, self.attributes = name, definition, table, attributes
        self._record, self._other, self._config = record, other, config

    def select(self, settings: dict[str, Any] | None = None, block: str | None = None) -> pd.DataFrame:
        """Rows of the points with these settings (flat keys) in this block, or in any."""
        chosen = self.table if block is None else self.table[self.table["block"] == block]
        for key, value in (settings or {}).items():
            chosen = chosen[chosen[key] == value]
        return chosen

    def grid(
        self, metric: str, settings: dict[str, Any] | None = None, block: str = "grid"
    ) -> pd.DataFrame:
        """A metric over h (index) and n (columns), NaN where it is missing.

        Raises Missing if there is not a single value, or several in a place.
        """
        chosen = self.select(settings, block)
        if metric not in chosen or chosen[metric].isna().all():
            raise Missing(f"{self.name}: no point of block {block} has {metric}")
        if chosen.duplicated(["h", "n"]).any():
            raise Missing(f"{self.name}: block {block} has several points with the same h and n")
        return chosen.pivot(index="h", columns="n", values=metric)

    def value(
        self, metric: str, settings: dict[str, Any] | None = None, block: str | None = None
    ) -> float:
        """A metric of the one point with these settings. Raises Missing if it is not there."""
        row = self._only(settings, block)
        if metric not in self.table or pd.isna(value := self.table.at[row, metric]):
            status = self.table.at[row, "status"]
            raise Missing(f"{self.name}: {self._label(row)} is {status}, without {metric}")
        return float(value)

    def record(self, settings: dict[str, Any] | None = None, block: str | None = None) -> xr.Dataset:
        """The record of the one point with these settings, which is done. Raises Missing otherwise."""
        row = self._only(settings, block)
        record = self._record(row)
        if record is None or self.table.at[row, "status"] != "done":
            raise Missing(f"{self.name}: {self._label(row)} is {self.table.at[row, 'status']}")
        return record

    def stored_at(self, row: int) -> xr.Dataset | None:
        """The record of a row of the table, by its index, whatever its outcome; None if there is none."""
        return self._record(row)

    def config(self, settings: dict[str, Any] | None = None, block: str | None = None) -> RunConfig:
        """The configuration of the one point with these settings, run or not. Raises Missing if there is
        not exactly one.
        """
        return self.config_at(self._only(settings, block))

    def config_at(self, row: int) -> RunConfig:
        """The configuration of a row of the table, by its index."""
        return self._config(row)

    def other(self, name: str, overrides: list[str] | None = None) -> "Results":
        """Another study in the same store, optionally with settings overridden ("n=21")."""
        if name == self.name and not overrides:
            return self
        return self._other(name, overrides or [])

    def _only(self, settings: dict[str, Any] | None, block: str | None) -> Any:
        chosen = self.select(settings, block)
        # The same point may stand in several blocks.
        found = chosen.drop_duplicates("record").index
        if len(found) != 1:
            where = ", ".join(f"{key}={value}" for key, value in (settings or {}).items())
            raise Missing(f"{self.name}: {len(found)} points with {where} in block {block}")
        return found[0]

    def _label(self, row: Any) -> str:
        point = self.table.loc[row]
        return f"{point['scene']} h={point['h']:g} n={point['n']}"


def load(name: str, hydra: Session, overrides: list[str], folder: str | None = None) -> Results:
    """The stored points of a study (those of studies it includes too), in the folder of results given.

    Metrics of another version are measured again from stored fields. Raises ConfigurationError if there
    is no such study.
    """
    where = folder or all_points(hydra, name, overrides)[1]
    members = study_file.members(name)

    # Whatever asks for another study shares what has been read.
    @cache
    def loaded(inner: str, changed: tuple[str, ...]) -> Results:
        return _load(inner, hydra, list(changed), where, other)

    def other(inner: str, changed: list[str]) -> Results:
        # What the whole study was asked for holds for its parts.
        return loaded(inner, (*(overrides if inner in members else ()), *changed))

    return loaded(name, tuple(overrides))


def _load(
    name: str,
    hydra: Session,
    overrides: list[str],
    folder: str,
    other: Callable[[str, list[str]], Results],
) -> Results:
    configs: list[RunConfig] = []
    places: list[dict[str, str]] = []
    for member in study_file.members(name):
        part = StudyPoints(hydra, member, overrides)
        for block, points in part.blocks.items():
            base = points[0].config.flat() if points else {}
            one_at_a_time = "vary" in study_file.load(member).blocks[block]
            for point in points:
                varied = _difference(base, point.config.flat()) if one_at_a_time else ""
                configs.append(point.config)
                places.append({"study": member, "block": block, "varied": varied})
    store = Store(folder)
    stored = points_table(configs, store, name)
    rows = [{**p, **c.flat(), **r} for p, c, r in zip(places, configs, stored.rows, strict=True)]

    # One record serves several figures in a row.
    @lru_cache(maxsize=8)
    def record(row: int) -> xr.Dataset | None:
        run = store.read(configs[row])
        return None if run is None else up_to_date(run, configs[row])

    definition, table = study_file.load(name), pd.DataFrame(rows)
    return Results(name, definition, table, stored.attributes, record, other, configs.__getitem__)


def _difference(base: dict[str, Any], flat: dict[str, Any]) -> str:
    return ", ".join(f"{key}={value}" for key, value in flat.items() if value != base.get(key))
