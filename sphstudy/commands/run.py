"""One run, or a sweep with -m; the word `run` may be left out.

    sphstudy [run] [-m] [key=value ...] [options]

Runs what is not stored yet and prints a table. Each run leaves one netCDF file
in results/runs, a sweep one dataset over all that was swept in results/sweeps.
A run that was interrupted goes on from its checkpoint.

    sphstudy h=1.5 n=40                        scene=mode1 method=thesis
    sphstudy -m h=1.3,1.5,1.7,1.9 n=40,50,60   every combination, in parallel
    sphstudy -m scene=plate method=thesis,tl   two methods, one dataset
    sphstudy --cfg job scene=plate h=1.7       settings of that run, not run
"""

from sphstudy.commands.parser import Request
from sphstudy.commands.points_table import print_outcome
from sphstudy.configuration.composition import session
from sphstudy.configuration.overrides import launcher_overrides
from sphstudy.running import sweep
from sphstudy.store.store import Store


def run(request: Request) -> int:
    """Runs what is not stored and prints all points; 1 if a point has no result."""
    settings = list(request.settings)
    with session(request.config_dir) as hydra:
        points, folder = hydra.points(settings, request.has("multirun"))
        launcher = launcher_overrides(settings)
        found, path = sweep.sweep(hydra, points, Store(folder), launcher, request.has("force"))
    return print_outcome(found, path)
