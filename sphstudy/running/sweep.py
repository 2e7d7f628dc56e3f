"""Many runs: what is there is kept, what is missing is run, longest first, all in one dataset."""

import sys
from pathlib import Path

import xarray as xr

from sphstudy.analysis import dataset
from sphstudy.commands import review
from sphstudy.commands.points_table import print_tables
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Point, Session, session
from sphstudy.configuration.overrides import launcher_overrides
from sphstudy.configuration.study_points import all_points
from sphstudy.errors import ConfigurationError
from sphstudy.running.launching import Launching, workers_of
from sphstudy.running.plan import kept, plan, prediction, print_plan
from sphstudy.running.progress import display
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store

_UNDONE = ("missing", "interrupted", "running")


def run_command(arguments: list[str], many: bool, force: bool) -> int:
    """`sphstudy [-m] key=value …`: one run or a sweep. Returns the exit status.

    Raises ConfigurationError on wrong input, before anything runs.
    """
    with session() as hydra:
        points, folder = hydra.points(arguments, many)
        combined, path = sweep(hydra, points, Store(folder), launcher_overrides(arguments), force)
    return _report(combined, path)


def study_command(arguments: list[str], force: bool, dry_run: bool) -> int:
    """`sphstudy study NAME [key=value …]`: all points of a named study, then comparison and report.

    With `dry_run` only tells what would run and what it would cost. Returns the exit status.
    """
    if not arguments or "=" in arguments[0]:
        raise ConfigurationError(
            [f"study: name one of {', '.join([*study_file.names(), study_file.SPEED[0]])}"]
        )
    name, overrides = arguments[0], arguments[1:]
    settings = [a for a in overrides if a not in launcher_overrides(overrides)]
    with session() as hydra:
        points, folder, skipped = all_points(hydra, name, settings)
        review.check(name)
        for complaint in skipped:
            print(f"left out: {complaint}")
        store = Store(folder)
        if dry_run:
            workers = workers_of(hydra.launcher(launcher_overrides(overrides)), points)
            print_plan(plan(points, store, force), store, workers)
            return 0
        called = review.report_name(name, settings)
        combined, path = sweep(hydra, points, store, launcher_overrides(overrides), force, called)
        status = _report(combined, path)
        if (
            study_file.load(name).forbid_diverged
            and (combined["status"] == STATUS.index("diverged")).any()
        ):
            print("a point diverged, which this study forbids")
            status = 1
        return max(status, review.review(hydra, name, settings, folder))


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
    store.prepare()
    planned = plan(points, store, force)
    if said := kept(planned):
        print(said, file=sys.stderr)
    pending = [p for p in planned if p.runs]
    pending.sort(key=lambda p: p.seconds, reverse=True)
    launching = Launching(store, [p.point for p in pending], hydra.launcher(launcher))
    for p in pending if force else ():
        store.checkpoint_path(p.point.config).unlink(missing_ok=True)
    if pending:
        print(prediction(pending), file=sys.stderr)
        costs = [(p.point.config, p.seconds) for p in pending]
        with display(costs, store, reused=len(planned) - len(pending)):
            launching.run()
    elsewhere = [p.point for p in planned if p.status == "running"]
    if elsewhere:
        launching.wait_for(elsewhere)
    configs = [p.config for p in points]
    combined = dataset.combine(configs, store)
    return combined, dataset.write(combined, configs, store, name)


def _report(combined: xr.Dataset, path: Path) -> int:
    print_tables(combined)
    print(f"dataset: {path}")
    bad = {name: int((combined["status"] == STATUS.index(name)).sum()) for name in ("failed", "timeout")}
    there = combined["configuration"] != ""
    without = int((there & combined["status"].isin([STATUS.index(name) for name in _UNDONE])).sum())
    for name, count in bad.items():
        if count:
            print(f"{count} {name}: the .log beside each record says more; retry={name} tries again")
    if without:
        print(f"{without} points have no record: they are run when asked for again")
    return 1 if without or any(bad.values()) else 0
