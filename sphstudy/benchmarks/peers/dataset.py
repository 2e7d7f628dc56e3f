"""The result of `sphstudy peers`: one labelled dataset, a point a case, and the ratios read from it."""

import json
import math
import time
from typing import Any

import numpy as np
import xarray as xr

from sphstudy.benchmarks.peers.measure import Case
from sphstudy.store.provenance import provenance

STATUS = ("missing", "done", "diverged", "failed", "timeout", "not set up")
"""Outcomes of a case; the dataset stores the position in this list."""

_NUMBERS = {
    "cpu_seconds": ("s", "CPU time of the time loop, median of repeats"),
    "frequency": ("rad s-1", "angular frequency"),
    "frequency_error_2d": ("1", "relative error of ω against two-dimensional elasticity"),
    "fit_residual": ("1", "rms residual of the fit over its amplitude"),
    "steps": ("1", "time steps"),
    "particles": ("1", "particles, or nodes"),
    "time_step": ("s", "time step"),
    "courant": ("1", "C of Δt = C Δy/c0"),
    "limit_share": ("1", "C over the largest stable C of the same code, measured"),
}
_TEXTS = {
    "message": "why there is no result",
    "versions": "releases, as JSON",
    "settings": "what its driver was given, as JSON",
    "title": "name for people",
}


def dataset(cases: list[Case]) -> xr.Dataset:
    """What was measured: over `point`, labelled code, setting, n and h; each repeat over `repeat`."""
    rows = [_row(case) for case in cases]
    repeats = max([1, *(len(case.seconds) for case in cases)])
    seconds = np.full((len(cases), repeats), np.nan)
    for row, case in zip(seconds, cases, strict=True):
        row[: len(case.seconds)] = case.seconds
    variables: dict[str, Any] = {
        name: ("point", [row[name] for row in rows], {"units": units, "long_name": meaning})
        for name, (units, meaning) in _NUMBERS.items()
    }
    variables |= {
        name: ("point", np.array([row[name] for row in rows], dtype=object), {"long_name": meaning})
        for name, meaning in _TEXTS.items()
    }
    variables["cpu_seconds_repeat"] = (
        ("point", "repeat"),
        seconds,
        {"units": "s", "long_name": "CPU time of the time loop, each repeat"},
    )
    variables["status"] = (
        "point",
        np.array([STATUS.index(case.status) for case in cases], np.int8),
        {
            "units": "1",
            "long_name": "outcome",
            "flag_values": np.arange(len(STATUS), dtype=np.int8),
            "flag_meanings": " ".join(word.replace(" ", "_") for word in STATUS),
        },
    )
    labels: dict[str, Any] = {
        "code": np.array([case.code.name for case in cases], dtype=object),
        "setting": np.array([case.setting for case in cases], dtype=object),
        "n": [case.plate.config.n for case in cases],
        "h": [case.code.h for case in cases],
    }
    found = xr.Dataset(variables, {name: ("point", values) for name, values in labels.items()})
    own = provenance()
    found.attrs = {
        "Conventions": "CF-1.11",
        "title": "Plate of the thesis, codes side by side",
        "date_created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        **{name: own[name] for name in ("processor", "operating_system", "python_version", "git_state")},
        "configuration": cases[0].plate.config.text,
        "frequency_2d": cases[0].plate.exact.value,
        "frequency_2d_uncertainty": cases[0].plate.exact.error,
    }
    return found


def _row(case: Case) -> dict[str, Any]:
    values = case.values
    frequency, residual = case.frequency()
    given = {k: v for k, v in case.settings.items() if k not in ("body", "output")}
    return {
        "cpu_seconds": case.cpu_seconds,
        "frequency": frequency,
        "frequency_error_2d": frequency / case.plate.exact.value - 1.0,
        "fit_residual": residual,
        "steps": values.get("steps", math.nan),
        "particles": values.get("particles", math.nan),
        "time_step": values.get("time_step", math.nan),
        "courant": case.courant,
        "limit_share": case.share,
        "message": case.message,
        "versions": json.dumps(values.get("versions", {})),
        "settings": json.dumps(given, sort_keys=True),
        "title": case.code.title,
    }


def ratios(found: xr.Dataset) -> list[str]:
    """The two comparisons that a reader asks for first, in words, from a dataset."""
    table = found.drop_dims("repeat").to_dataframe()
    table = table[table["status"] == STATUS.index("done")]
    lines = []
    for n in sorted(table["n"].unique()):
        for setting, words in (("limit", "at 0.9 of their limits"), ("usual", "at their usual C")):
            rows = table[(table["n"] == n) & (table["setting"] == setting)].set_index("code")
            if {"pysph", "sphstudy thesis"} <= set(rows.index):
                ratio = rows["cpu_seconds"]["pysph"] / rows["cpu_seconds"]["sphstudy thesis"]
                lines.append(
                    f"n = {n}, {words}: PySPH takes {ratio:.3g} times the CPU of sphstudy thesis"
                )
            lines += _against_machdyn(rows, f"n = {n}, {words}")
    return lines


def _against_machdyn(rows, where: str) -> list[str]:
    """MACHDYN against the cheapest of this program's stepped runs whose error is no larger."""
    if "lammps" not in rows.index:
        return []
    peer = rows.loc["lammps"]
    own = rows[rows.index.str.startswith("sphstudy tl")]
    good = own[own["frequency_error_2d"].abs() <= abs(peer["frequency_error_2d"])]
    if good.empty:
        return [f"{where}: no total Lagrangian run of sphstudy is as close as MACHDYN's"]
    best = good.loc[good["cpu_seconds"].idxmin()]
    ratio = peer["cpu_seconds"] / best["cpu_seconds"]
    errors = (
        f"{100 * best['frequency_error_2d']:+.2f} % against {100 * peer['frequency_error_2d']:+.2f} %"
    )
    return [f"{where}: MACHDYN takes {ratio:.3g} times the CPU of {best.name} ({errors})"]
