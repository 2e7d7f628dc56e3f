"""The tables of a report: points, effects of options, error against cost, comparisons, settings."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pandas as pd

from sphstudy import text
from sphstudy.analysis.compare import Comparison
from sphstudy.analysis.dimensions import ALWAYS, dimensions
from sphstudy.analysis.effects import Effect
from sphstudy.analysis.results import Results
from sphstudy.catalogue import headline
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.table import Cell, Column, Table

COST = ("cpu_seconds", "steps", "particles")
"""Columns of every table of points, after the scene's own metrics."""

LONGEST = 2000
"""Points of a group, or points not done, that a page lists at most: more of them make it slow."""

_NUMBER = (int, float)


@dataclass(frozen=True)
class Setting:
    """A setting that all points of a group share."""

    key: str
    value: str
    meaning: str


@dataclass(frozen=True)
class Group:
    """The points of one scene in one block of a study: rows of the table and their configurations."""

    results: Results
    block: str
    scene: str
    rows: pd.DataFrame
    configs: list[RunConfig]

    @cached_property
    def one_at_a_time(self) -> bool:
        """Whether the block varies one setting at a time."""
        return bool((self.rows["varied"] != "").any())

    @property
    def headline(self) -> list[str]:
        """The metrics for tables of its points, without those that no point of the study has."""
        kinds = dict.fromkeys((config.scene.name, config.solve.name) for config in self.configs)
        names = dict.fromkeys(name for kind in kinds for name in headline(*kind))
        return [name for name in names if name in self.results.attributes]

    def units(self, metric: str) -> str:
        """The unit that the metric is stored in."""
        return str(self.results.attributes[metric]["units"])

    def column(self, metric: str) -> Column:
        """The column of a metric or cost."""
        meaning = str(self.results.attributes[metric]["long_name"])
        return Column(text.heading(metric, self.units(metric)), meaning)

    def cell(self, metric: str, value: float) -> Cell:
        """The cell of a metric or cost."""
        return Cell(text.metric(metric, value, self.units(metric)), value)


def groups(results: Results, rows: pd.DataFrame) -> Iterator[Group]:
    """Divides rows of the results' table into groups, in order."""
    for (block, scene), chosen in rows.groupby(["block", "scene"], sort=False):
        configs = [results.config_at(row) for row in chosen.index]
        yield Group(results, str(block), str(scene), chosen, configs)


def points(group: Group) -> Table:
    """A row for each of the first LONGEST points: settings that differ, outcome, metrics and cost."""
    metrics = [*group.headline, *(name for name in COST if name in group.results.attributes)]
    told_apart = _told_apart(group)
    columns = [
        Column(key, _meaning(group.configs[0], key), numeric) for key, numeric in told_apart.items()
    ]
    if group.one_at_a_time:
        columns.append(Column("changed setting", "what differs from the block's first point", False))
    columns += [Column("status", "outcome of the run", False), *map(group.column, metrics)]
    rows = []
    shown = group.rows.head(LONGEST)
    for (_, point), config in zip(shown.iterrows(), group.configs[:LONGEST], strict=True):
        row = [_setting_cell(config.flat().get(key)) for key in told_apart]
        if group.one_at_a_time:
            row.append(Cell(point["varied"] or "none"))
        row.append(Cell(point["status"], badge=True))
        rows.append([*row, *(group.cell(name, point[name]) for name in metrics)])
    caption = f"Points of block {group.block}, scene {group.scene}"
    if len(group.rows) > LONGEST:
        caption += f": the first {LONGEST} of {len(group.rows)}, which are all in the study's dataset"
    return Table(caption, columns, rows)


def _told_apart(group: Group) -> dict[str, bool]:
    """Keys of the settings that differ, h and n always, and whether their values are numbers."""
    swept: dict[str, list[Any]] = dimensions([config.flat() for config in group.configs])
    if group.one_at_a_time:
        swept = {key: swept[key] for key in ALWAYS}
    return {
        key: all(isinstance(value, _NUMBER) and not isinstance(value, bool) for value in values)
        for key, values in swept.items()
    }


def _setting_cell(value: Any) -> Cell:
    return Cell(text.setting(value), value if isinstance(value, _NUMBER) else None)


def effects(group: Group, found: list[Effect]) -> Table:
    """A row for each changed setting: the change of each metric. found: the effects in the group."""
    metrics = [name for name in group.headline if any(effect.metric == name for effect in found)]
    base = {effect.metric: effect.base for effect in found}
    changes = {(effect.varied, effect.metric): effect.change for effect in found}
    first = [Cell("none (value)"), *(group.cell(name, base[name]) for name in metrics)]
    rows = [first]
    controls = {effect.varied for effect in found if effect.is_control}
    for varied in dict.fromkeys(effect.varied for effect in found):
        row = [Cell(f"{varied} (control)" if varied in controls else varied)]
        for name in metrics:
            change = changes.get((varied, name), float("nan"))
            row.append(Cell(text.metric(name, change, group.units(name), sign=True), change))
        rows.append(row)
    columns = [Column("changed setting", numeric=False), *map(group.column, metrics)]
    return Table(f"Change by each option in block {group.block}", columns, rows)


def cost(group: Group) -> Table | None:
    """A row for each resolution: CPU time and range of each relative error. None if there is only one."""
    done = group.rows[group.rows["status"] == "done"]
    if group.one_at_a_time or done["n"].nunique() < 2:
        return None
    errors = [name for name in group.headline if text.is_share(name, group.units(name))]
    titles = ["n", "points", "particles", "CPU a point (s)", "CPU in all (s)"]
    columns = [*map(Column, titles)]
    columns += [
        Column(f"|{name.replace('_', ' ')}| (%)", "smallest and largest of these points")
        for name in errors
    ]
    rows = []
    for n, chosen in done.groupby("n"):
        seconds = chosen["cpu_seconds"]
        numbers = (float(n), len(chosen), chosen["particles"].iloc[0], seconds.mean(), seconds.sum())
        row = [Cell(text.number(value, 3), value) for value in numbers]
        rows.append(row + [_range(name, chosen[name].abs()) for name in errors])
    return Table(f"Error against cost in block {group.block}", columns, rows)


def _range(name: str, values: pd.Series) -> Cell:
    smallest, largest = values.min(), values.max()
    if smallest == largest:
        return Cell(text.metric(name, largest, "1"), largest)
    return Cell(f"{text.metric(name, smallest, '1')} to {text.metric(name, largest, '1')}", largest)


def comparison(caption: str, found: list[Comparison]) -> Table:
    """A row for each value compared with its accepted interval."""
    titles = ("study", "cell", "metric", "value", "accepted", "verdict", "distance", "why this interval")
    numeric = ("value", "distance")
    meanings = {
        "accepted": "interval that the value should lie in",
        "distance": "from the middle of the interval in half-widths: more than 1 is outside",
    }
    columns = [Column(title, meanings.get(title, ""), title in numeric) for title in titles]
    return Table(caption, columns, [_compared(item) for item in found])


def _compared(item: Comparison) -> list[Cell]:
    value, lower, upper = (
        text.metric(item.metric, number, item.units) for number in (item.value, item.lower, item.upper)
    )
    return [
        Cell(item.study),
        Cell(item.cell),
        Cell(text.heading(item.metric, item.units)),
        Cell(value, item.value),
        Cell(f"{lower} to {upper}", item.lower),
        Cell(item.verdict, badge=True),
        Cell(text.number(item.excess, 3), item.excess),
        Cell(item.reason),
    ]


def common_settings(group: Group) -> list[Setting]:
    """The settings that all points of the group share."""
    flat = [config.flat() for config in group.configs]
    shared = {
        key: value for key, value in flat[0].items() if all(other.get(key) == value for other in flat)
    }
    return [
        Setting(key, text.setting(value), _meaning(group.configs[0], key))
        for key, value in shared.items()
    ]


def _meaning(config: RunConfig, key: str) -> str:
    """The meaning of a setting, from the Parameters that declare it."""
    part, _, name = key.partition(".")
    owner: Any = getattr(config, part) if name else config
    meaning: str = type(owner).__pydantic_fields__[name or part].description or ""
    return meaning.removesuffix(" [1]")
