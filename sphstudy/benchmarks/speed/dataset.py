"""Everything measured as one labelled dataset, with the machine it holds for."""

import time
from collections.abc import Sequence
from operator import attrgetter
from typing import Any

import llvmlite.binding
import numpy as np
import xarray as xr

from sphstudy.benchmarks.speed.bounds import SOURCE, flatness, reached
from sphstudy.benchmarks.speed.columns import BOUNDS, PARTS, RATES, RUNS, SCALINGS, STARTS, Column
from sphstudy.benchmarks.speed.measurements import Measurements
from sphstudy.benchmarks.speed.settings import Settings
from sphstudy.store.provenance import provenance


def dataset(found: Measurements, settings: Settings) -> xr.Dataset:
    """All measurements; dimensions rate, scaling, start, run, bound, part, flat, as far as measured."""
    flat = list(flatness(found).items())
    tables: dict[str, tuple[Sequence[Any], tuple[Column, ...], list[str]]] = {
        "rate": (found.rates, RATES, [r.case.label for r in found.rates]),
        "scaling": (found.scalings, SCALINGS, [f"{s.workers}: {s.label}" for s in found.scalings]),
        "start": (found.starts, STARTS, [f"{s.method}, n={s.n}" for s in found.starts]),
        "run": (found.runs, RUNS, [r.label for r in found.runs]),
        "bound": (bounded := reached(found), BOUNDS, [r.label for r in bounded]),
        "part": (found.parts, PARTS, [p.name for p in found.parts]),
    }
    variables: dict[str, Any] = {}
    for dimension, (rows, columns, labels) in tables.items():
        if rows:
            variables |= _columns(dimension, rows, columns)
            variables[dimension] = _variable(dimension, labels, "1", f"name of the {dimension}")
    variables |= _rounds(found)
    if flat:
        labels = [", ".join(form) for form, _ in flat]
        variables["flat"] = _variable("flat", labels, "1", "method and arrangement")
        variables["flatness"] = _variable(
            "flat", [value for _, value in flat], "1", "largest time per pair over smallest, over sizes"
        )
    return xr.Dataset(variables, attrs=_attributes(found, settings))


def _columns(dimension: str, rows: Sequence[Any], columns: tuple[Column, ...]) -> dict[str, Any]:
    return {
        name: _variable(dimension, [attrgetter(attribute)(row) for row in rows], units, long_name)
        for name, units, long_name, attribute in columns
    }


def _rounds(found: Measurements) -> dict[str, Any]:
    """Times of every round, NaN where a measurement had fewer rounds."""
    variables = {}
    several: dict[str, tuple[tuple[str, ...], list[np.ndarray], str]] = {
        "step_times": (("rate",), [r.seconds for r in found.rates], "CPU time of a step in each round"),
        "run_times": (("run",), [r.seconds for r in found.runs], "CPU time of a run in each round"),
        "scaling_times": (
            ("scaling", "workers"),
            [s.seconds for s in found.scalings],
            "wall time of the same work with one and two workers in each round",
        ),
        "control_times": (
            ("scaling", "workers"),
            [s.control for s in found.scalings],
            "wall time of the control in each round",
        ),
    }
    longest = max((a.shape[-1] for _, arrays, _ in several.values() for a in arrays), default=0)
    for name, (dimensions, arrays, long_name) in several.items():
        if arrays:
            whole = np.full((len(arrays), *arrays[0].shape[:-1], longest), np.nan)
            for row, taken in zip(whole, arrays, strict=True):
                row[..., : taken.shape[-1]] = taken
            variables[name] = _variable((*dimensions, "round"), whole, "s", long_name)
    if found.scalings:
        variables["workers"] = _variable("workers", [1, 2], "1", "threads or processes")
    return variables


def _variable(dimensions: Any, values: Any, units: str, long_name: str) -> tuple:
    return (dimensions, np.asarray(values), {"units": units, "long_name": long_name})


def _attributes(found: Measurements, settings: Settings) -> dict[str, Any]:
    return {
        "title": "speed of the program on one machine: compare ratios only",
        "date_created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        "quick": str(settings.quick),
        "rounds": settings.rounds,
        "turn_seconds": settings.slice_seconds,
        "remarks": "; ".join(found.remarks),
        "bound_source": SOURCE,
        "processor_kind": llvmlite.binding.get_host_cpu_name(),
        **provenance(),
    }
