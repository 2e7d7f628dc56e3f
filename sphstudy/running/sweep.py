"""Many runs: what is there is kept, what is missing is run, longest first, all in one dataset."""

import sys
from pathlib import Path

import xarray as xr

from sphstudy.analysis import dataset
from sphstudy.configuration.composition import Point, Session
from sphstudy.running.launching import Launching
from sphstudy.running.plan import kept, plan, prediction
from sphstudy.running.progress import display
from sphstudy.store.lock import remove_lost
from sphstudy.store.store import CLAIM, Store, record_beside


def sweep(
    hydra: Session,
    points: list[Point],
    store: Store,
    launcher: list[str],
    force: bool = False,
    name: str | None = None,
) -> tuple[xr.Dataset, Path]:
    """Runs what is not in the store, and collects all points.

    Parameters
    ----------
    hydra : Session
        Composes the launcher.
    points : list of Point
        The runs.
    store : Store
        Where their records are, or will be.
    launcher : list of str
        Overrides that choose and configure the launcher.
    force : bool
        Whether stored runs are run again.
    name : str, optional
        Of the combined dataset; made of what was swept if not given.

    Returns
    -------
    xarray.Dataset, Path
        The combined dataset, and the file that it was written to.

    Raises
    ------
    ConfigurationError
        If the folder cannot be written, a solver refuses a point, or the launcher is wrong.
    """
    store.prepare()
    # A process that was killed between its record and its claim leaves both.
    remove_lost(path for path in store.files(CLAIM) if record_beside(path).exists())
    planned = plan(points, store, force)
    if remark := kept(planned):
        print(remark, file=sys.stderr)
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
    combined = dataset.combine(configs, store, known=[None if p.runs else p.stored for p in planned])
    return combined, dataset.write(combined, configs, store, name)
