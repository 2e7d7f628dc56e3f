"""The report of a study: one HTML page that needs no other file, and the figures beside it as files."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import jinja2
import pandas as pd

from sphstudy import text
from sphstudy.analysis import compare
from sphstudy.analysis.claims import claim
from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED
from sphstudy.analysis.compare import OUTSIDE, UNSTABLE, WITHIN, Comparison
from sphstudy.analysis.results import Results
from sphstudy.analysis.stability.judge import DEGRADED
from sphstudy.report import sections, tables
from sphstudy.report.sections import Origin
from sphstudy.table import Table

WORST = 8
"""Comparisons shown at once; the fold below has all of them."""

_TONES = {
    **dict.fromkeys((REPRODUCED, WITHIN, "done"), "good"),
    **dict.fromkeys((PARTLY, UNSTABLE, DEGRADED, "running", "interrupted"), "middling"),
    **dict.fromkeys((NOT, OUTSIDE, "diverged", "failed", "timeout"), "bad"),
}


@dataclass(frozen=True)
class Compared:
    """A comparison with accepted intervals. counts: how many values have each verdict."""

    id: str
    title: str
    counts: str
    worst: Table
    all: Table


def write(results: Results, folder: Path) -> Path:
    """Writes the report of a study, of those that it includes and of those that it shows.

    Parameters
    ----------
    results : Results
        The study.
    folder : Path
        Where index.html is written, with figures, style and script inside, and the figures once more:
        figures/<name>.png and .pdf or .gif.

    Returns
    -------
    Path
        Of the page. Where a figure lacks data or fails, the page says why.
    """
    folder.mkdir(parents=True, exist_ok=True)
    found = sections.studies(results)
    claims = claim.checked(results)
    parts = [sections.section(one, folder / "figures") for one in found]
    shown = [one.table for one in found if one.name in results.definition.shows]
    page = _environment().get_template("page.html.jinja")
    path = folder / "index.html"
    path.write_text(
        page.render(
            name=results.name,
            title=results.definition.title,
            summary=sections.summary(results.table),
            shown=sections.summary(pd.concat(shown)) if shown else "",
            origins=sections.origins(found),
            claims=claims,
            verdicts=_counts(finding.verdict for _, finding in claims),
            comparisons=_comparisons(results),
            sections=[part for part in parts if part.drawings or part.summary],
        ),
        encoding="utf-8",
    )
    return path


def _comparisons(results: Results) -> list[Compared]:
    both = (
        ("reference", "Comparison with stored references", compare.against_reference(results)),
        ("thesis-values", "Comparison with the thesis's printed values", compare.against_thesis(results)),
    )
    return [_compared(id, title, found) for id, title, found in both if found]


def _compared(id: str, title: str, found: list[Comparison]) -> Compared:
    return Compared(
        id,
        title,
        _counts(item.verdict for item in found),
        tables.comparison(f"{title}: worst first", found[:WORST]),
        tables.comparison(f"{title}: all", found),
    )


def _counts(verdicts: Iterable[str]) -> str:
    return ", ".join(f"{count} {verdict}" for verdict, count in Counter(verdicts).most_common())


def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["tone"] = lambda verdict: _TONES.get(verdict, "none")
    environment.filters["counted"] = text.counted
    environment.filters["period"] = _period
    return environment


def _period(origins: list[Origin]) -> str:
    """When the first and the last record were begun."""
    first, last = min(o.first for o in origins), max(o.last for o in origins)
    return _moment(first) if first == last else f"{_moment(first)} to {_moment(last)}"


def _moment(date: str) -> str:
    """An ISO date to the minute, without its T and Z."""
    return date[:16].replace("T", " ")
