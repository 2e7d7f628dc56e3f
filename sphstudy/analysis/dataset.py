"""From records to one labelled dataset."""

import hashlib
import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from sphstudy.configuration.run_settings import RunConfig
from sphstudy.store import identity, provenance, record
from sphstudy.store.measured import measured
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store, write
from sphstudy.store.summary import Summary

ALWAYS = ("h", "n")
"""Dimensions of every combined dataset, swept or not."""

ORIGIN = (
    "message", "git_state", "date_created", "sphstudy_version", "python_version", "library_versions",
    "processor",
)  # fmt: skip
"""Global attributes of a record that tables carry too."""

SPARSEST = 8
"""A dataset over what was swept has at most so many cells a point."""


def dimensions(configs: list[RunConfig]) -> dict[str, list[Any]]:
    """The swept keys, h and n included, each with its values in order of appearance, numbers sorted."""
    return _swept([config.flat() for config in configs])


def _swept(flat: list[dict[str, Any]]) -> dict[str, list[Any]]:
    keys = dict.fromkeys(itertools.chain.from_iterable(flat))
    swept = {}
    for key in keys:
        column = [point.get(key) for point in flat]
        if key not in ALWAYS and column.count(column[0]) == len(column):
            continue
        values = list(dict.fromkeys(map(hashable, column)))
        if len(values) > 1 or key in ALWAYS:
            numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)
            swept[key] = sorted(values) if numbers else values
    return _without_consequences(swept, flat)


def _without_consequences(
    swept: dict[str, list[Any]], flat: list[dict[str, Any]]
) -> dict[str, list[Any]]:
    """Leaves out what follows from a choice of scene, method or solve: it varies only along with it."""
    choices = [key for key in ("scene", "method", "solve") if key in swept]
    if not choices:
        return swept
    kept = dict(swept)
    for key in swept:
        if key in choices or key in ALWAYS:
            continue
        by_choice: dict[tuple, set] = {tuple(p.get(c) for c in choices): set() for p in flat}
        for p in flat:
            by_choice[tuple(p.get(c) for c in choices)].add(hashable(p.get(key)))
        if all(len(values) == 1 for values in by_choice.values()):
            del kept[key]
    return kept


def hashable(value: Any) -> Any:
    """The value, or as JSON text what is neither a number nor text; "null" for NaN, which tables have
    where there is no number.
    """
    if isinstance(value, float) and math.isnan(value):
        return "null"
    return value if isinstance(value, int | float | str | np.generic) else json.dumps(value)


def collect(configs: list[RunConfig], store: Store, name: str | None = None) -> tuple[xr.Dataset, Path]:
    """All points in one dataset over what was swept, written to the store's `sweeps` folder.

    Metrics of another version are measured again from the stored fields. Points without a record are
    there as "missing". Where the points fill less than an eighth of the product of all swept values, the
    dataset has the one dimension `point`, and what was swept are coordinates along it. Returns the
    dataset and its file, `name` or a name made from the points.
    """
    flat = [config.flat() for config in configs]
    swept = _swept(flat)
    found, attributes = rows(configs, store)
    table = pd.DataFrame(found).drop(columns=[key for key in ORIGIN if key != "message"])
    table["configuration"] = [config.text for config in configs]
    places = pd.DataFrame([{key: hashable(point.get(key)) for key in swept} for point in flat])
    if math.prod(map(len, swept.values())) > SPARSEST * len(configs):
        dataset = _list(table, places, attributes)
    else:
        dataset = _grid(table, places, swept, attributes)
    dataset.attrs = {
        "Conventions": "CF-1.11",
        "title": f"sweep over {', '.join(swept)}",
        "source": "sphstudy, smoothed particle hydrodynamics of elastic solids",
        **provenance.provenance(),
    }
    path = store.folder / "sweeps" / f"{name or _name(configs)}.nc"
    write(dataset, path)
    return dataset, path


def rows(
    configs: list[RunConfig], store: Store
) -> tuple[list[dict[str, Any]], dict[str, dict[str, Any]]]:
    """For each configuration its status, record, origin (ORIGIN), metrics and cost.

    Beside them, units and meaning of each metric and cost. Metrics of another version are measured again.
    """
    found: list[dict[str, Any]] = []
    attributes: dict[str, dict[str, Any]] = {}
    for config in configs:
        path = store.record_path(config)
        summary = _current(config, path, store)
        row: dict[str, Any] = {
            "status": store.status(config) if summary is None else summary.status,
            "record": path.name,
            **{key: "" if summary is None else summary.attributes[key] for key in ORIGIN},
        }
        if summary is not None:
            row |= summary.numbers
            attributes |= summary.described
        found.append(row)
    store.index.flush()
    return found, attributes


def _current(config: RunConfig, path: Path, store: Store) -> Summary | None:
    """The summary of a run, whose record has this path, with metrics of today's version."""
    summary = store.summary_at(path)
    if summary is None or summary.status != "done":
        return summary
    if summary.attributes["metrics_version"] != identity.metrics_version(config):
        run = store.read(config)
        if run is None:
            return None
        store.keep(config, measured(run, config))
        return store.summary(config)
    return summary


def _grid(
    table: pd.DataFrame, places: pd.DataFrame, swept: dict[str, list[Any]], attributes: dict
) -> xr.Dataset:
    """The points unfolded over every swept key; cells that are no point are "missing"."""
    index = pd.MultiIndex.from_frame(places)
    full = pd.MultiIndex.from_product(swept.values(), names=list(swept))
    table = table.set_axis(index, axis=0).reindex(full)
    shape = [len(values) for values in swept.values()]
    coordinates = {key: (key, _coordinate(values)) for key, values in swept.items()}
    return _dataset(table, list(swept), shape, coordinates, attributes)


def _list(table: pd.DataFrame, places: pd.DataFrame, attributes: dict) -> xr.Dataset:
    """The points one after the other."""
    coordinates = {key: ("point", _coordinate(places[key].tolist())) for key in places}
    return _dataset(table, ["point"], [len(table)], coordinates, attributes)


def _dataset(
    table: pd.DataFrame, dims: list[str], shape: list[int], coordinates: dict, attributes: dict
) -> xr.Dataset:
    dataset = xr.Dataset(coords=coordinates)
    for key in coordinates:
        dataset[key].attrs = {"long_name": _meaning(key), "units": "1"}
    for name, column in table.items():
        if name == "status":
            codes = column.fillna("missing").map(STATUS.index).to_numpy()
            dataset[name] = record.status_variable(dims, codes.reshape(shape))
        elif name in _TEXTS:
            values = column.fillna("").to_numpy(dtype=object).reshape(shape)
            dataset[name] = (dims, values, {"units": "1", "long_name": _TEXTS[name]})
        else:
            values = column.to_numpy(dtype=float).reshape(shape)
            dataset[name] = (dims, values, attributes[str(name)])
    return dataset


_TEXTS = {
    "record": "file of the record",
    "message": "what went wrong",
    "configuration": "resolved configuration of the run, JSON",
}


def _coordinate(values: list[Any]) -> np.ndarray:
    if all(isinstance(value, int | float) for value in values):
        return np.array(values)
    return np.array([str(value) for value in values], dtype=object)


def _meaning(key: str) -> str:
    return {"h": "relative smoothing radius", "n": "resolution"}.get(key, key)


def _name(configs: list[RunConfig]) -> str:
    """Scenes and methods for people, a hash of all points for certainty."""
    scenes = "+".join(dict.fromkeys(c.scene.name for c in configs))
    methods = "+".join(dict.fromkeys(c.method.name for c in configs))
    digest = hashlib.sha256(" ".join(sorted(identity.key(c) for c in configs)).encode())
    return f"{scenes}-{methods}-{digest.hexdigest()[:8]}"
