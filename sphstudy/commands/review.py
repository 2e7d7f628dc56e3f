"""What is made of stored results without running anything: comparison, report, references, metrics."""

import math
import re
import time
from collections import Counter
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy.analysis import compare, dataset, reference
from sphstudy.analysis.claims import claim
from sphstudy.analysis.compare import MISSING, OUTSIDE, Comparison
from sphstudy.analysis.results import load
from sphstudy.analysis.stability import bounds
from sphstudy.commands.points_table import print_tables
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Session, session
from sphstudy.configuration.execution import SETTINGS
from sphstudy.configuration.study_points import all_points
from sphstudy.console import console
from sphstudy.errors import ConfigurationError
from sphstudy.store.measured import measured
from sphstudy.store.netcdf import read_dataset
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store

SHOWN = 20
"""Rows of a comparison that are printed unless all are asked for."""


def report_name(name: str, overrides: list[str]) -> str:
    """Name of a study's dataset and report: that of the study, and the settings that differ from it."""
    changed = [o for o in overrides if o.partition("=")[0] not in SETTINGS]
    return re.sub(r"[^\w.+=-]+", "_", "-".join([name, *changed]))


def check(name: str) -> None:
    """Raises ConfigurationError if a study names a claim, figure or study that does not exist, or is to
    be judged while a file of bounds is wrong.
    """
    # Drawing takes a second to load, which no other command should wait for.
    from sphstudy.report import figure

    for member in dict.fromkeys([*study_file.members(name), *study_file.load(name).shows]):
        definition = study_file.load(member)
        for claim_id in definition.claims:
            claim.find(claim_id)
        for figure_name in definition.figures:
            figure.find(figure_name)
        if definition.judged:
            bounds.check()


def review(hydra: Session, name: str, overrides: list[str], folder: str) -> int:
    """Compares a study with its references, prints its claims and writes its report.

    Returns 1 if a metric lies outside its accepted interval, else 0.
    """
    # Drawing takes a second to load, which no other command should wait for.
    from sphstudy.report.page import write as write_page

    found = load(name, hydra, overrides, folder)
    for one, finding in claim.checked(found):
        print(f"claim {one.id}: {finding.verdict}: {finding.numbers}")
    compared = compare.against_reference(found)
    if compared:
        outside = _print(compared, SHOWN)[OUTSIDE]
    else:
        outside = 0
        print(f"{name}: there is no stored reference to compare with")
    began = time.perf_counter()
    path = write_page(found, Path(folder) / "reports" / report_name(name, overrides))
    print(f"report: {path} ({time.perf_counter() - began:.0f} s)")
    return 1 if outside else 0


def report_command(arguments: list[str]) -> int:
    """`sphstudy report STUDY [key=value …]`: figures and page from stored data."""
    name, overrides = named(arguments, "report")
    with session() as hydra:
        folder = _folder(hydra, name, overrides)
        Store(folder).prepare()
        return review(hydra, name, overrides, folder)


def measure_command(arguments: list[str]) -> int:
    """`sphstudy measure STUDY [key=value …]`: metrics again from stored fields, without running."""
    name, overrides = named(arguments, "measure")
    with session() as hydra:
        points, folder, _ = all_points(hydra, name, overrides)
        store, count = Store(folder), 0
        store.prepare()
        for point in points:
            run = store.read(point.config)
            if run is not None and STATUS[int(run["status"])] == "done":
                store.keep(point.config, measured(run, point.config))
                count += 1
        configs = [point.config for point in points]
        combined = dataset.combine(configs, store, name)
        path = dataset.write(combined, configs, store, report_name(name, overrides))
    print_tables(combined)
    print(f"{count} of {len(points)} points measured again\ndataset: {path}")
    return 0


def reference_command(arguments: list[str]) -> int:
    """`sphstudy reference STUDY`: stored results become the stored reference."""
    name, overrides = named(arguments, "reference")
    if any(not o.startswith("results=") for o in overrides):
        raise ConfigurationError(["reference: takes a study as it is, and results=FOLDER"])
    with session() as hydra:
        for member, made in reference.make(hydra, name, _folder(hydra, name, overrides)).items():
            print(f"reference: {reference.write(made, member)}")
    return 0


def compare_command(arguments: list[str]) -> int:
    """`sphstudy compare A [B] [tolerance=1e-6] [all=true]`: a table; 1 if anything is outside or missing.

    Raises ConfigurationError on wrong input, and if there is nothing to compare.
    """
    given = [a for a in arguments if "=" not in a]
    options = dict(a.partition("=")[::2] for a in arguments if "=" in a)
    shown, text = options.pop("all", "false"), options.pop("tolerance", "1e-6")
    results = options.pop("results", "results")
    files = len(given) == 2 and given[1] != "printed"
    if options or not 1 <= len(given) <= 2 or (given[0].endswith(".nc") and not files):
        raise ConfigurationError(
            ["compare: write compare STUDY, compare STUDY printed or compare FILE FILE (see --help)"]
        )
    if shown not in ("true", "false"):
        raise ConfigurationError([f"all={shown}: should be true or false"])
    try:
        if not 0.0 <= (tolerance := float(text)) < math.inf:
            raise ValueError
    except ValueError:
        raise ConfigurationError([f"tolerance={text}: should be a number, not negative"]) from None
    rows = _compared(given, files, results, tolerance)
    if not rows:
        raise ConfigurationError([f"compare {' '.join(given)}: there is nothing to compare"])
    counts = _print(rows, None if shown == "true" else SHOWN)
    return 1 if counts[OUTSIDE] or counts[MISSING] else 0


def _compared(given: list[str], files: bool, results: str, tolerance: float) -> list[Comparison]:
    if files:
        after, before = (read_dataset(name, results) for name in given)
        try:
            return compare.between(after, before, tolerance)
        except ValueError as error:
            raise ConfigurationError([f"compare {' '.join(given)}: {error}"]) from None
    with session() as hydra:
        found = load(given[0], hydra, [f"results={results}"])
    return compare.against_thesis(found) if given[1:] else compare.against_reference(found)


def _print(rows: list[Comparison], limit: int | None) -> Counter[str]:
    """Prints the rows, worst first; returns how many there are of each verdict."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("metric", "cell", "value", "accepted", "unit", "verdict", "reason"):
        table.add_column(heading, justify="right" if heading == "value" else "left", overflow="fold")
    for row in rows[:limit]:
        interval = f"{row.lower:.6g} … {row.upper:.6g}"
        table.add_row(
            row.metric, row.cell, f"{row.value:.6g}", interval, row.units, row.verdict, row.reason
        )
    console().print(table)
    counts = Counter(row.verdict for row in rows)
    print("compared: " + ", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
    if limit is not None and len(rows) > limit:
        print(f"the {limit} worst of {len(rows)} are shown; all of them with `compare … all=true`")
    return counts


def named(arguments: list[str], command: str) -> tuple[str, list[str]]:
    """Study and overrides among a command's arguments. Raises ConfigurationError if there are others."""
    if not arguments or "=" in arguments[0]:
        raise ConfigurationError([f"{command}: name one of {', '.join(study_file.names())}"])
    if wrong := [a for a in arguments[1:] if "=" not in a]:
        raise ConfigurationError([f"{a}: neither a flag of {command} nor key=value" for a in wrong])
    return arguments[0], arguments[1:]


def _folder(hydra: Session, name: str, overrides: list[str]) -> str:
    return all_points(hydra, name, overrides)[1]
