"""Whether two folders of results hold the same numbers to the last bit.

`python -m tests.stress.bits FOLDER FOLDER` compares each record of the second folder with the records of
the first that have its label and its configuration: all variables that both have, except times and
memory. A setting counts by its own name, in whichever section it stands, so that records from before it
moved (solve.damping, method.damping) find their partners; settings that only one record has are left out.

Exit status: 0 if all are the same, 1 if a number differs or if nothing could be compared.
"""

import json
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

MACHINE = ("cpu_seconds", "wall_seconds", "compile_seconds", "peak_memory")
"""Variables that belong to the machine, not to the run."""


def settings(record: xr.Dataset) -> dict[str, list[str]]:
    """Values of each setting as sorted JSON, by its name without its section."""
    found = defaultdict(list)

    def collect(name: str, value: Any) -> None:
        if isinstance(value, dict):
            for inner, content in value.items():
                collect(inner, content)
        else:
            found[name].append(json.dumps(value))

    collect("", json.loads(record.attrs["configuration"]))
    return {name: sorted(values) for name, values in found.items()}


def alike(one: xr.Dataset, other: xr.Dataset) -> bool:
    """Whether two records have the same label, and the same values of all settings that both have."""
    if one.title != other.title:
        return False
    mine, theirs = settings(one), settings(other)
    return all(mine[name] == theirs[name] for name in mine.keys() & theirs.keys())


def differing(one: xr.Dataset, other: xr.Dataset) -> list[str]:
    """Names of the variables of both records whose values differ in a bit."""
    shared = [name for name in one.data_vars if name in other.data_vars and name not in MACHINE]
    return [str(name) for name in shared if not _same(one[name].values, other[name].values)]


def _same(one: np.ndarray, other: np.ndarray) -> bool:
    if one.dtype.kind == other.dtype.kind == "f":
        # Bytes, since -0 equals 0 and NaN equals nothing.
        return one.shape == other.shape and one.astype(float).tobytes() == other.astype(float).tobytes()
    return bool(np.array_equal(one, other))


def records(folder: Path) -> Iterator[tuple[str, xr.Dataset]]:
    """The records below a folder of results, by the names of their files."""
    for path in sorted((folder / "runs").glob("*.nc")):
        with xr.open_dataset(path) as opened:
            yield path.name, opened.load()


def compare(before: Path, after: Path) -> tuple[int, list[str]]:
    """How many pairs of records were compared, and a line for each that differs."""
    known, compared, lines = list(records(before)), 0, []
    for name, record in records(after):
        partners = [(other, found) for other, found in known if alike(found, record)]
        if not partners:
            print(f"{name}: no partner in {before}")
        for other, partner in partners:
            compared += 1
            if names := differing(partner, record):
                lines.append(f"{name} and {other} differ in {', '.join(names)}")
    return compared, lines


def main() -> int:
    if len(sys.argv) != 3:
        print("usage: python -m tests.stress.bits FOLDER FOLDER")
        return 2
    before, after = (Path(argument) for argument in sys.argv[1:])
    compared, lines = compare(before, after)
    print("\n".join([*lines, f"{compared} pairs of records compared, {len(lines)} differ"]))
    return int(bool(lines) or not compared)


if __name__ == "__main__":
    sys.exit(main())
