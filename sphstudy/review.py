"""What is made of stored results without running anything: comparison, report, references, metrics."""

import re
import time
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy import collect, compare, reference, study
from sphstudy.blocks import all_points
from sphstudy.claims.claim import checked
from sphstudy.compare import OUTSIDE, Comparison
from sphstudy.composition import Session, session
from sphstudy.config import ConfigurationError
from sphstudy.record import STATUS
from sphstudy.results import Results, load
from sphstudy.runner import measured
from sphstudy.store import Store, read_dataset, write
from sphstudy.tables import console, print_tables

SHOWN = 20
"""Rows of a comparison that are printed unless all are asked for."""


def report_name(name: str, overrides: list[str]) -> str:
    """Name of a study's dataset and report: that of the study, and the settings that differ from it."""
    changed = [o for o in overrides if not o.startswith(("results=", "checkpoint="))]
    return re.sub(r"[^\w.+=-]+", "_", "-".join([name, *changed]))


def review(hydra: Session, name: str, overrides: list[str], folder: str) -> int:
    """Compares a study with its references, prints its claims and writes its report.

    Returns 1 if a metric lies outside its accepted interval, else 0.
    """
    # Drawing takes a second to load, which no other command should wait for.
    from sphstudy.report.page import write as write_page

    found = load(name, hydra, overrides, folder)
    for claim, finding in checked(found):
        print(f"claim {claim.id}: {finding.verdict}: {finding.numbers}")
    status = _print_reference(found, SHOWN)
    began = time.perf_counter()
    path = write_page(found, Path(folder) / "reports" / report_name(name, overrides))
    print(f"report: {path} ({time.perf_counter() - began:.0f} s)")
    return status


def report_command(arguments: list[str]) -> int:
    """`sphstudy report STUDY [key=value …]`: figures and page from stored data."""
    name, overrides = _named(arguments, "report")
    with session() as hydra:
        return review(hydra, name, overrides, _folder(hydra, name, overrides))


def measure_command(arguments: list[str]) -> int:
    """`sphstudy measure STUDY [key=value …]`: metrics again from stored fields, without running."""
    name, overrides = _named(arguments, "measure")
    with session() as hydra:
        points, folder, _ = all_points(hydra, name, overrides)
        store, count = Store(folder), 0
        for point in points:
            run = store.read(point.config)
            if run is not None and STATUS[int(run["status"])] == "done":
                write(measured(run, point.config), store.record_path(point.config))
                count += 1
        configs = [point.config for point in points]
        dataset, path = collect.collect(configs, store, report_name(name, overrides))
    print_tables(dataset)
    print(f"{count} of {len(points)} points measured again\ndataset: {path}")
    return 0


def reference_command(arguments: list[str]) -> int:
    """`sphstudy reference STUDY`: stored results become the stored reference."""
    name, overrides = _named(arguments, "reference")
    if any(not o.startswith("results=") for o in overrides):
        raise ConfigurationError(["reference: takes a study as it is, and results=FOLDER"])
    with session() as hydra:
        for path in reference.make(hydra, name, _folder(hydra, name, overrides)):
            print(f"reference: {path}")
    return 0


def compare_command(arguments: list[str]) -> int:
    """`sphstudy compare A [B] [tolerance=1e-6] [all=true]`: a table; 1 if anything lies outside."""
    given = [a for a in arguments if "=" not in a]
    options = dict(a.partition("=")[::2] for a in arguments if "=" in a)
    limit = None if options.pop("all", "false") == "true" else SHOWN
    text = options.pop("tolerance", "1e-6")
    results = options.pop("results", "results")
    if options or not 1 <= len(given) <= 2:
        raise ConfigurationError(
            ["compare: write compare STUDY, compare STUDY printed or compare FILE FILE (see --help)"]
        )
    try:
        tolerance = float(text)
    except ValueError:
        raise ConfigurationError([f"tolerance={text}: should be a number"]) from None
    if given[0].endswith(".nc") or (len(given) == 2 and given[1] != "printed"):
        after, before = (read_dataset(name, results) for name in (given[0], given[-1]))
        return _print(compare.between(after, before, tolerance), limit)
    with session() as hydra:
        found = load(given[0], hydra, [f"results={results}"])
        if given[1:] == ["printed"]:
            return _print(compare.against_thesis(found), limit)
        return _print_reference(found, limit)


def _print_reference(found: Results, limit: int | None) -> int:
    members = study.members(found.name)
    if not any(reference.load(member) is not None for member in members):
        print(f"{found.name}: there is no stored reference to compare with")
        return 0
    return _print(compare.against_reference(found), limit)


def _print(rows: list[Comparison], limit: int | None) -> int:
    """Prints the rows, worst first; returns 1 if any is outside."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("metric", "cell", "value", "accepted", "unit", "verdict", "reason"):
        table.add_column(heading, justify="right" if heading == "value" else "left", overflow="fold")
    for row in rows[:limit]:
        interval = f"{row.lower:.6g} … {row.upper:.6g}"
        table.add_row(
            row.metric, row.cell, f"{row.value:.6g}", interval, row.units, row.verdict, row.reason
        )
    console().print(table)
    counts = {v: sum(row.verdict == v for row in rows) for v in dict.fromkeys(r.verdict for r in rows)}
    print("compared: " + (", ".join(f"{c} {verdict}" for verdict, c in counts.items()) or "nothing"))
    if limit is not None and len(rows) > limit:
        print(f"the {limit} worst of {len(rows)} are shown; all of them with `compare … all=true`")
    return 1 if counts.get(OUTSIDE) else 0


def _named(arguments: list[str], command: str) -> tuple[str, list[str]]:
    if not arguments or "=" in arguments[0]:
        raise ConfigurationError([f"{command}: name one of {', '.join(study.names())}"])
    return arguments[0], arguments[1:]


def _folder(hydra: Session, name: str, overrides: list[str]) -> str:
    return all_points(hydra, name, overrides)[1]
