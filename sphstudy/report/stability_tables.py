"""Tables of judged runs: the stability map run by run, the bounds with their reasons, values quoted."""

import math
from collections import Counter

from sphstudy import text
from sphstudy.analysis.results import Results
from sphstudy.analysis.stability.bounds import Bound, Quoted
from sphstudy.analysis.stability.bounds import quoted as read_quoted
from sphstudy.analysis.stability.cases import OUTCOMES, Case
from sphstudy.analysis.stability.judge import DEGRADED, DIVERGED, DONE
from sphstudy.table import Cell, Column, Table


def stability_map(cases: list[Case]) -> Table:
    """A row for each run: outcome, when, by which indicator, its value and bound."""
    columns = [
        Column("scene", numeric=False),
        Column("settings", "what varies among the runs of the scene", False),
        Column("method", "and what is not as usual in the scene", False),
        Column("h"),
        Column("outcome", "done: inside all bounds; degraded: outside one, but finite", False),
        Column("when (s)", "first sample outside a bound, or where it diverged; of a metric, the end"),
        Column("by", "the bound that was broken first", False),
        Column("value", "farthest outside of the bound"),
        Column("bound", numeric=False),
        Column("also outside, or how it ended", numeric=False),
    ]
    return Table("Stability map", columns, [_row(case) for case in cases])


def _row(case: Case) -> list[Cell]:
    found = case.judgement
    first, others = next(iter(found.breaches), None), found.breaches[1:]
    also = [f"{_name(one.bound)} {text.number(one.value, 3)} ({one.bound.interval})" for one in others]
    # General bounds ask for much that a scene does not have; a run that diverged ended too early for its
    # metrics. Neither is worth a word.
    asked = [bound for bound in found.unjudged if not bound.general and found.outcome != DIVERGED]
    unjudged = [f"not judged: {_name(bound)}" for bound in asked]
    return [
        Cell(case.scene),
        Cell(case.settings),
        Cell(case.variant),
        Cell(text.number(case.h), case.h),
        Cell(found.outcome, badge=True),
        Cell(text.number(found.time, 3), None if math.isnan(found.time) else found.time),
        Cell(_name(first.bound) if first else ""),
        Cell(text.number(first.value, 3), first.value) if first else Cell(text.NOTHING),
        Cell(first.bound.interval if first else ""),
        Cell("; ".join(filter(None, [*also, *unjudged, found.message]))),
    ]


def bounds(cases: list[Case]) -> Table:
    """A row for each bound of these runs, with reason and source."""
    columns = [
        Column("scene", numeric=False),
        Column("quantity", numeric=False),
        Column("bound", numeric=False),
        Column("for", "settings of the runs that it is for", False),
        Column("broken", "runs outside it, of those that have the quantity"),
        Column("reason", numeric=False),
        Column("where the case comes from", numeric=False),
    ]
    scenes: dict[tuple[int, str], tuple[Bound, list[Case]]] = {}
    for case in cases:
        for bound in case.bounds:
            scene = "any" if bound.general else case.scene
            scenes.setdefault((id(bound), scene), (bound, []))[1].append(case)
    rows = [_bound(scene, bound, those) for (_, scene), (bound, those) in scenes.items()]
    return Table("Bounds of a sound run", columns, sorted(rows, key=lambda row: row[0].text == "any"))


def _bound(scene: str, bound: Bound, cases: list[Case]) -> list[Cell]:
    judged = [case.judgement for case in cases if case.judgement.outcome in (DONE, DEGRADED, DIVERGED)]
    having = [one for one in judged if bound not in one.unjudged]
    broken = sum(any(breach.bound is bound for breach in one.breaches) for one in having)
    where = ", ".join(f"{key} {text.setting(value)}" for key, value in bound.where.items())
    return [
        Cell(scene),
        Cell(_name(bound)),
        Cell(bound.interval),
        Cell(where),
        Cell(f"{broken} of {len(having)}", broken),
        Cell(bound.reason),
        Cell(bound.source),
    ]


def quoted(results: Results, cases: list[Case]) -> Table | None:
    """A row for each value that others found, beside those of finite runs here; None without any."""
    columns = [
        Column("scene", numeric=False),
        Column("quantity", numeric=False),
        Column("found", "by others", False),
        Column("by", numeric=False),
        Column("here", "smallest and largest by each method, of runs that did not diverge", False),
    ]
    rows = [
        _quoted(results, [case for case in cases if case.scene == scene], one)
        for scene in dict.fromkeys(case.scene for case in cases)
        for one in read_quoted(scene)
    ]
    return Table("What others found", columns, rows) if rows else None


def _quoted(results: Results, cases: list[Case], one: Quoted) -> list[Cell]:
    found: dict[str, list[float]] = {}
    for case in cases:
        value = (
            results.table[one.quantity].get(case.row, math.nan)
            if one.quantity in results.table
            else math.nan
        )
        if not math.isnan(value):
            found.setdefault(case.variant, []).append(value)
    here = [f"{variant}: {_range(min(values), max(values))}" for variant, values in found.items()]
    return [
        Cell(cases[0].scene),
        Cell(text.heading(one.quantity, one.units)),
        Cell(_range(*one.between)),
        Cell(one.source),
        Cell("; ".join(here) or text.NOTHING),
    ]


def _range(low: float, high: float) -> str:
    return text.number(low) if low == high else f"{text.number(low)} to {text.number(high)}"


def counts(cases: list[Case]) -> str:
    """The number of runs of each outcome, in words."""
    found = Counter(case.judgement.outcome for case in cases)
    return ", ".join(f"{found[outcome]} {outcome}" for outcome in reversed(OUTCOMES) if found[outcome])


def _name(bound: Bound) -> str:
    return (bound.indicator or bound.quantity).replace("_", " ")
