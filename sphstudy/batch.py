"""Many runs: what is there is kept, what is missing is run, longest first, all in one dataset."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import xarray as xr
from hydra.core.utils import setup_globals
from joblib.externals.loky import get_reusable_executor

from sphstudy import collect, study
from sphstudy.composition import Point, Session, launcher_overrides, session
from sphstudy.config import (
    ConfigurationError,
    RunConfig,
    method_module,
    scene_module,
    solver_module,
)
from sphstudy.display import display
from sphstudy.record import STATUS
from sphstudy.runner import task
from sphstudy.store import REUSED, Store


@dataclass(frozen=True)
class Planned:
    """A point, the status that the store has of it, and its predicted cost in arbitrary units."""

    point: Point
    status: str
    cost: float


def prospect(config: RunConfig) -> tuple[float, list[str]]:
    """Cost of a run, and what the solver has to complain about it once it sees the problem.

    The cost is steps times pairs: enough to order runs and to share out the time left.
    """
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    solver, problem = solver_module(config.solve.name), scene.build(config)
    steps = solver.predicted_steps(problem, config, method)
    cost = steps * scene.particles(config) * method.lattice_neighbours(config) / 2.0
    return cost, list(solver.check(problem, config, method))


def run_command(arguments: list[str], many: bool, force: bool) -> int:
    """`sphstudy [-m] key=value …`: one run or a sweep. Returns the exit status.

    Raises ConfigurationError on wrong input, before anything runs.
    """
    with session() as hydra:
        points, folder = hydra.points(arguments, many)
        dataset, path = sweep(hydra, points, Store(folder), launcher_overrides(arguments), force)
    return _report(dataset, path, points)


def study_command(arguments: list[str], force: bool) -> int:
    """`sphstudy study NAME [key=value …]`: all points of a named study. Returns the exit status."""
    if not arguments or "=" in arguments[0]:
        raise ConfigurationError([f"study: name one of {', '.join(study.names())}"])
    name, overrides = arguments[0], arguments[1:]
    with session() as hydra:
        points, folder = study_points(hydra, name, overrides)
        store, launcher = Store(folder), launcher_overrides(overrides)
        dataset, path = sweep(hydra, points, store, launcher, force, name)
    return _report(dataset, path, points)


def study_points(hydra: Session, name: str, overrides: list[str]) -> tuple[list[Point], str]:
    """All points of a named study, each once, and the folder of results."""
    found: dict[str, Point] = {}
    folder = ""
    for grid in study.grids(name):
        given = {override.partition("=")[0] for override in overrides}
        kept = [setting for setting in grid if setting.partition("=")[0] not in given]
        points, folder = hydra.points([*kept, *overrides], sweep=True)
        found |= {str(point.config): point for point in points}
    if not found:
        raise ConfigurationError([f"study {name}: no points"])
    return list(found.values()), folder


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
    prospects = [prospect(p.config) for p in points]
    if complaints := [complaint for _, found in prospects for complaint in found]:
        raise ConfigurationError(complaints)
    store.prepare()
    planned = [
        Planned(p, store.status(p.config), cost) for p, (cost, _) in zip(points, prospects, strict=True)
    ]
    pending = [p for p in planned if force or p.status not in REUSED]
    pending.sort(key=lambda p: p.cost, reverse=True)
    # A single run stays in this process: starting another takes longer than many a run.
    if not launcher and len(pending) <= 1:
        launcher = ["hydra/launcher=basic"]
    ready = hydra.launcher(task, launcher)
    for p in pending if force else ():
        store.checkpoint_path(p.point.config).unlink(missing_ok=True)
    if pending:
        jobs = [[*p.point.overrides, f"results={store.folder}"] for p in pending]
        costs = [(p.point.config, p.cost) for p in pending]
        with _clean_interrupt(), display(costs, store, reused=len(planned) - len(pending)):
            setup_globals()
            ready.launch(jobs, initial_job_idx=0)
    return collect.collect([p.config for p in points], store, name)


def _report(dataset: xr.Dataset, path: Path, points: list[Point]) -> int:
    collect.print_tables(dataset, [p.config for p in points])
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
