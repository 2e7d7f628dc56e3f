"""Many runs: what is there is kept, what is missing is run, longest first, all in one dataset."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import xarray as xr
from hydra.core.utils import setup_globals
from joblib.externals.loky import get_reusable_executor

from sphstudy import collect
from sphstudy.composition import Point, Session, launcher_overrides, session
from sphstudy.config import method_module, scene_module, solver_module
from sphstudy.display import display
from sphstudy.record import STATUS
from sphstudy.run import task
from sphstudy.store import REUSED, Store


@dataclass(frozen=True)
class Planned:
    """A point, the status that the store has of it, and its predicted cost in arbitrary units."""

    point: Point
    status: str
    cost: float


def plan(points: list[Point], store: Store) -> list[Planned]:
    """What is known of each point; the cost is steps times pairs."""
    return [
        Planned(point, store.status(point.config), predicted_cost(point.config)) for point in points
    ]


def predicted_cost(config) -> float:
    """Steps times pairs: enough to order runs and to share out the time left."""
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    problem = scene.build(config)
    steps = solver_module(config.solve.name).predicted_steps(problem, config, method)
    return steps * scene.particles(config) * method.lattice_neighbours(config.h) / 2.0


def run(arguments: list[str], many: bool, force: bool) -> int:
    """The command: composes, validates, runs what is missing, prints the table. Exit status.

    Raises ConfigurationError on wrong input, before anything runs.
    """
    with session() as hydra:
        points, folder = hydra.points(arguments, many)
        store = Store(folder)
        store.prepare()
        dataset, path = sweep(hydra, points, store, launcher_overrides(arguments), force)
    collect.print_table(dataset, [p.config for p in points])
    print(f"dataset: {path}")
    failed = int((dataset["status"] == STATUS.index("failed")).sum())
    if failed:
        print(f"{failed} failed: the traceback is in the .log file beside the record")
    return 1 if failed else 0


def sweep(
    hydra: Session, points: list[Point], store: Store, launcher: list[str], force: bool
) -> tuple[xr.Dataset, Path]:
    """Runs what is not in the store (everything with `force`), and collects all points.

    Returns the combined dataset and the file it was written to.
    """
    planned = plan(points, store)
    pending = [p for p in planned if force or p.status not in REUSED]
    pending.sort(key=lambda p: p.cost, reverse=True)
    if pending:
        _launch(hydra, pending, store, launcher, reused=len(planned) - len(pending))
    return collect.collect([p.config for p in points], store)


def _launch(
    hydra: Session, pending: list[Planned], store: Store, launcher: list[str], reused: int
) -> None:
    # A single run stays in this process: starting another takes longer than many a run.
    chosen = launcher or (["hydra/launcher=basic"] if len(pending) == 1 else [])
    jobs = [[*p.point.overrides, f"results={store.folder}"] for p in pending]
    with (
        _clean_interrupt(),
        display([(p.point.config, p.cost) for p in pending], store, reused),
    ):
        setup_globals()
        hydra.launcher(task, chosen).launch(jobs, initial_job_idx=0)


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
