"""What pairs, terms, a start and a second core cost here.

    sphstudy speed [--quick] [--parts PART,...] [options]

Measures the program on this machine, always anew, and writes
results/speed/speed.nc with figures beside it. `sphstudy study speed` is the
same command.

    sphstudy speed --quick                     a minute of CPU time
    sphstudy speed --parts forms,terms         only these parts
    sphstudy speed --dry-run                   parts, and what they took last
"""

import sys
from pathlib import Path

from sphstudy.benchmarks.speed.settings import PARTS, Settings, chosen
from sphstudy.commands.parser import Request
from sphstudy.errors import ConfigurationError


def run(request: Request) -> int:
    """Measures, writes <results>/speed/speed.nc and figures beside it, prints tables; always anew.

    With --dry-run only tells what would be measured, and what that took the last time. Returns 1 if a
    system went bad before it was timed.
    """
    settings = chosen(request.options)
    path = Path(settings.results) / "speed" / "speed.nc"
    if request.has("dry-run"):
        _print_plan(settings, path)
        return 0
    # Loaded only now: wrong input is answered at once.
    from sphstudy.benchmarks.speed.dataset import dataset
    from sphstudy.benchmarks.speed.figures import write_figures
    from sphstudy.benchmarks.speed.measurements import measure
    from sphstudy.benchmarks.speed.tables import print_tables
    from sphstudy.configuration.composition import session
    from sphstudy.store.netcdf import write
    from sphstudy.store.store import Store

    Store(settings.results).prepare()
    with session() as hydra:
        found = measure(hydra, settings, lambda text: print(text, file=sys.stderr, flush=True))
    measured = dataset(found, settings)
    write(measured, path)
    print_tables(measured)
    for figure in write_figures(measured, path.parent):
        print(f"figure: {figure}")
    print(f"dataset: {path}")
    return 1 if any(rate.wrong for rate in found.rates) else 0


def _print_plan(settings: Settings, path: Path) -> None:
    before = _before(path)
    for part in settings.parts:
        print(f"{part}: {PARTS[part]}{before.get(part, '')}")
    print(f"would be measured with {settings.rounds} rounds, whatever {path} holds")


def _before(path: Path) -> dict[str, str]:
    """What each part took when it was measured last."""
    from sphstudy.store.netcdf import read_dataset

    if not path.is_file():
        return {}
    found = read_dataset(str(path), path.parent)
    if "part" not in found.dims:
        raise ConfigurationError([f"{path}: was not written by `sphstudy speed`"])
    quick = " (quick)" if found.attrs["quick"] == "True" else ""
    return {
        str(part): f"; {seconds:.0f} s of CPU time the last time{quick}"
        for part, seconds in zip(found["part"].values, found["part_cpu_time"].values, strict=True)
    }
