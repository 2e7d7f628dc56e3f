"""A study beside its reference or the thesis, or two datasets.

    sphstudy compare STUDY [printed] [options]
    sphstudy compare FILE FILE [options]

Compares stored results of a study with its reference, or with the values that
the thesis prints, or two datasets (names or .nc files) cell by cell. The worst
rows come first. Exit status 1: a value is missing, or outside its interval.

    sphstudy compare mode1                     with the stored reference
    sphstudy compare mode1 printed             with the ranges of the thesis
    sphstudy compare a.nc b.nc --tolerance 1e-9
"""

import math
from collections import Counter

from sphstudy.analysis import compare
from sphstudy.analysis.compare import MISSING, OUTSIDE, Comparison
from sphstudy.analysis.results import load
from sphstudy.commands.parser import Request
from sphstudy.configuration.composition import session
from sphstudy.console import print_table
from sphstudy.errors import ConfigurationError
from sphstudy.store.netcdf import read_dataset
from sphstudy.table import Column, Table
from sphstudy.text import NOTHING

SHOWN = 20
"""Rows of a comparison that are printed unless all are asked for."""


def run(request: Request) -> int:
    """Prints the comparison; 1 if anything is outside or missing."""
    words = request.words
    files = len(words) == 2 and words[1] != "printed"
    if words[0].endswith(".nc") and not files:
        raise request.misused()
    tolerance = request.number("tolerance", 1e-6, least=0.0)
    rows = _files(request, tolerance) if files else _study(request)
    if not rows:
        raise ConfigurationError([f"compare {' '.join(words)}: there is nothing to compare"])
    counts = print_comparison(rows, None if request.has("all") else SHOWN)
    return 1 if counts[OUTSIDE] or counts[MISSING] else 0


def _files(request: Request, tolerance: float) -> list[Comparison]:
    after, before = (read_dataset(name, request.results) for name in request.words)
    try:
        return compare.between(after, before, tolerance)
    except ValueError as error:
        raise ConfigurationError([f"compare {' '.join(request.words)}: {error}"]) from None


def _study(request: Request) -> list[Comparison]:
    with session() as hydra:
        found = load(request.words[0], hydra, [f"results={request.results}"])
    return compare.against_thesis(found) if request.words[1:] else compare.against_reference(found)


def print_comparison(rows: list[Comparison], limit: int | None) -> Counter[str]:
    """Prints a comparison.

    Parameters
    ----------
    rows : list of Comparison
        Worst first.
    limit : int or None
        How many are printed; None: all.

    Returns
    -------
    Counter
        How many rows there are of each verdict.
    """
    headings = ("metric", "cell", "value", "accepted", "unit", "verdict", "reason")
    texts = []
    for row in rows[:limit]:
        value = NOTHING if math.isnan(row.value) else f"{row.value:.6g}"
        numbers = value, f"{row.lower:.6g} … {row.upper:.6g}"
        texts.append([row.metric, row.cell, *numbers, row.units, row.verdict, row.reason])
    print_table(Table.of_texts([Column(text, numeric=text == "value") for text in headings], texts))
    counts = Counter(row.verdict for row in rows)
    print("compared: " + ", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
    if limit is not None and len(rows) > limit:
        print(f"the {limit} worst of {len(rows)} are shown; --all prints all")
    return counts
