"""What a study of 20 000 points costs: python -m tests.stress.scale 20000 [FOLDER].

The records are copies of a small one under the names of other points. Prints wall time and peak memory of
each command, as a user would type it, in a process of its own.
"""

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import netCDF4
import yaml

from sphstudy.configuration.composition import Point, session
from sphstudy.running import sweep
from sphstudy.store import identity
from sphstudy.store.checksum import HOW, SEALED, seal
from sphstudy.store.netcdf import write
from sphstudy.store.store import Store
from sphstudy.store.summary import of_record


def grid(count: int, folder: str) -> list[str]:
    """Overrides that span so many points: four h, fifty durations, and as many densities as it takes."""
    densities = max(1, count // 200)
    return [
        "scene=plate",
        "n=5",
        "method=tl",
        "record.samples=10",
        "h=1.3,1.4,1.5,1.6",
        "scene.periods=" + ",".join(f"{0.1 + 0.01 * k:g}" for k in range(50)),
        "scene.rho=" + ",".join(f"{7000 + k:g}" for k in range(densities)),
        f"results={folder}",
    ]


def make(points: list[Point], store: Store) -> None:
    """Computes the first point, and copies its record, fields and all, for all others."""
    with session() as hydra:
        sweep.sweep(hydra, points[:1], store, [])
    record = store.read(points[0].config)
    assert record is not None
    with tempfile.TemporaryDirectory() as scratch:
        template = Path(scratch) / "template.nc"
        write(record.assign_attrs({SEALED: HOW}), template, "NETCDF3_64BIT")
        for point in points[1:]:
            record.attrs["configuration"], record.attrs["key"] = (
                point.config.text,
                identity.key(point.config),
            )
            path = store.record_path(point.config)
            shutil.copy(template, path)
            with netCDF4.Dataset(path, "a") as copy:
                copy.configuration, copy.key = record.attrs["configuration"], record.attrs["key"]
            seal(path, of_record(record).text)


def timed(label: str, *arguments: str, program: Sequence[str] = ("-m", "sphstudy")) -> None:
    """Runs a command of the program and prints what it took."""
    begun = time.perf_counter()
    command = [sys.executable, *program, *arguments]
    result = subprocess.run(command, capture_output=True, text=True)
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    last = (result.stdout.strip().splitlines() or [result.stderr])[-1]
    print(f"{label}: {time.perf_counter() - begun:.1f} s, at most {memory:.0f} MiB so far; {last[:90]}")


def report(count: int, folder: str) -> None:
    """The same of a report on a study of these points, in a process of its own."""
    with tempfile.TemporaryDirectory() as scratch:
        block: dict[str, Any] = {}
        for setting in grid(count, folder):
            key, _, value = setting.partition("=")
            if key != "results":
                block[key] = value.split(",") if "," in value else value
        study = {"title": "Very many points", "blocks": {"grid": block}}
        (Path(scratch) / "many.yaml").write_text(yaml.safe_dump(study))
        program = (
            "import sys; from pathlib import Path; from sphstudy import __main__, catalogue;"
            f"catalogue.FOLDERS['studies'] = Path({scratch!r});"
            "sys.exit(__main__.main(sys.argv[1:]))"
        )
        timed("report", "report", "many", f"results={folder}", program=["-c", program])


def main(count: int, folder: str) -> None:
    """Makes the records, if they are not there, and times the commands."""
    overrides, store = grid(count, folder), Store(folder)
    with session() as hydra:
        points, _ = hydra.points(overrides, sweep=True)
    store.prepare()
    if sum(1 for _ in store.runs.glob("*.nc")) < len(points):
        begun = time.perf_counter()
        make(points, store)
        print(f"{len(points)} records made in {time.perf_counter() - begun:.0f} s")
    timed("status, first time", "status", f"results={folder}")
    timed("status, again", "status", f"results={folder}")
    timed("combined dataset, first time", "-m", *overrides)
    timed("combined dataset, again", "-m", *overrides)
    report(count, folder)
    timed("prune", "prune", f"results={folder}")


if __name__ == "__main__":
    given = sys.argv[1:]
    main(int(given[0]) if given else 20_000, given[1] if len(given) > 1 else tempfile.mkdtemp())
