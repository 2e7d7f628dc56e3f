"""Many runs: what is there is kept, what is missing is run, longest first, all in one dataset."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import xarray as xr
from hydra.core.utils import setup_globals
from joblib.externals.loky import get_reusable_executor
from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy import collect, review, study
from sphstudy.blocks import all_points
from sphstudy.composition import Point, Session, launcher_overrides, session
from sphstudy.config import ConfigurationError
from sphstudy.display import display, duration
from sphstudy.prediction import prospect, rates
from sphstudy.record import STATUS
from sphstudy.runner import task
from sphstudy.store import REUSED, Store
from sphstudy.tables import console, print_tables


@dataclass(frozen=True)
class Planned:
    """A point, the status that the store has of it, and its predicted CPU time (s)."""

    point: Point
    status: str
    seconds: float


def plan(points: list[Point], store: Store) -> list[Planned]:
    """What is known of the points before anything runs.

    Raises ConfigurationError with what solvers have to complain about them.
    """
    prospects = [prospect(point.config) for point in points]
    if complaints := [complaint for _, found in prospects for complaint in found]:
        raise ConfigurationError(complaints)
    known = rates(store)
    return [
        Planned(p, store.status(p.config), known.seconds(p.config, cost))
        for p, (cost, _) in zip(points, prospects, strict=True)
    ]


def run_command(arguments: list[str], many: bool, force: bool) -> int:
    """`sphstudy [-m] key=value …`: one run or a sweep. Returns the exit status.

    Raises ConfigurationError on wrong input, before anything runs.
    """
    with session() as hydra:
        points, folder = hydra.points(arguments, many)
        dataset, path = sweep(hydra, points, Store(folder), launcher_overrides(arguments), force)
    return _report(dataset, path)


def study_command(arguments: list[str], force: bool, dry_run: bool) -> int:
    """`sphstudy study NAME [key=value …]`: all points of a named study, then comparison and report.

    With `dry_run` only tells what would run and what it would cost. Returns the exit status.
    """
    if not arguments or "=" in arguments[0]:
        raise ConfigurationError([f"study: name one of {', '.join(study.names())}"])
    name, overrides = arguments[0], arguments[1:]
    settings = [a for a in overrides if a not in launcher_overrides(overrides)]
    with session() as hydra:
        points, folder, skipped = all_points(hydra, name, settings)
        review.check(name)
        for complaint in skipped:
            print(f"left out: {complaint}")
        store = Store(folder)
        if dry_run:
            print_plan(plan(points, store), force)
            return 0
        called = review.report_name(name, settings)
        dataset, path = sweep(hydra, points, store, launcher_overrides(overrides), force, called)
        status = _report(dataset, path)
        if study.load(name).forbid_diverged and (dataset["status"] == STATUS.index("diverged")).any():
            print("a point diverged, which this study forbids")
            status = 1
        return max(status, review.review(hydra, name, settings, folder))


def print_plan(planned: list[Planned], force: bool) -> None:
    """A table of the points: whether they would run, why, and the CPU time predicted."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("point", "would run", "because", "CPU (s)"):
        table.add_column(heading, justify="right" if heading.startswith("CPU") else "left")
    for p in sorted(planned, key=lambda p: -p.seconds):
        runs = force or p.status not in REUSED
        reason = "forced" if force and p.status in REUSED else f"stored: {p.status}"
        if p.status == "missing":
            reason = "not in the store"
        table.add_row(p.point.config.label, "yes" if runs else "no", reason, f"{p.seconds:.1f}")
    console().print(table)
    print(_prediction([p for p in planned if force or p.status not in REUSED]))


def _prediction(pending: list[Planned]) -> str:
    seconds = sum(p.seconds for p in pending)
    return f"{len(pending)} runs to do, about {duration(seconds)} of CPU time"


def sweep(
    hydra: Session,
    points: list[Point],
    store: Store,
    launcher: list[str],
    force: bool = False,
    name: str | None = None,
) -> tuple[xr.Dataset, Path]:
    """Runs what is not in the store (everything with `force`), and collects all points.

    Returns the combined dataset and the file it was written to, called `name` if given.
    """
    planned = plan(points, store)
    store.prepare()
    pending = [p for p in planned if force or p.status not in REUSED]
    pending.sort(key=lambda p: p.seconds, reverse=True)
    # A single run stays in this process: starting another takes longer than many a run.
    if not launcher and len(pending) <= 1:
        launcher = ["hydra/launcher=basic"]
    threads = max((p.point.threads for p in pending), default=1)
    if not launcher and threads > 1:
        launcher = [f"hydra.launcher.n_jobs={max(1, (os.cpu_count() or 1) // threads)}"]
    ready = hydra.launcher(task, launcher)
    for p in pending if force else ():
        store.checkpoint_path(p.point.config).unlink(missing_ok=True)
    if pending:
        print(_prediction(pending), file=sys.stderr)
        jobs = [[*p.point.overrides, f"results={store.folder}"] for p in pending]
        costs = [(p.point.config, p.seconds) for p in pending]
        with _clean_interrupt(), display(costs, store, reused=len(planned) - len(pending)):
            setup_globals()
            ready.launch(jobs, initial_job_idx=0)
    return collect.collect([p.config for p in points], store, name)


def _report(dataset: xr.Dataset, path: Path) -> int:
    print_tables(dataset)
    print(f"dataset: {path}")
    failed = int((dataset["status"] == STATUS.index("failed")).sum())
    if failed:
        print(f"{failed} failed: the traceback is in the .log file beside the record")
    return 1 if failed else 0


@contextmanager
def _clean_interrupt() -> Iterator[None]:
    """On Ctrl-C, and on a polite kill, takes the workers along: no orphans, no waiting."""

    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    except BaseException:
        get_reusable_executor().shutdown(wait=False, kill_workers=True)
        raise
    finally:
        signal.signal(signal.SIGTERM, before)
