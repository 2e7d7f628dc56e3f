"""From records to one labelled dataset, and from the dataset to a table."""

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from sphstudy import identity, provenance, record
from sphstudy.config import RunConfig, scene_module
from sphstudy.record import STATUS
from sphstudy.runner import measured
from sphstudy.store import Store, write

ALWAYS = ("h", "n")
"""Dimensions of every combined dataset, swept or not."""


def dimensions(configs: list[RunConfig]) -> dict[str, list[Any]]:
    """The swept keys, h and n included, each with its values in order of appearance, numbers sorted."""
    flat = [config.flat() for config in configs]
    keys = {key: None for point in flat for key in point}
    swept = {}
    for key in keys:
        values = list({_hashable(point.get(key)): None for point in flat})
        if len(values) > 1 or key in ALWAYS:
            numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)
            swept[key] = sorted(values) if numbers else values
    return _without_consequences(swept, flat)


def _without_consequences(
    swept: dict[str, list[Any]], flat: list[dict[str, Any]]
) -> dict[str, list[Any]]:
    """Leaves out what follows from a choice of scene, method or solve: it varies only along with it."""
    choices = [key for key in ("scene", "method", "solve") if key in swept]
    kept = dict(swept)
    for key in swept:
        if key in choices or key in ALWAYS:
            continue
        by_choice: dict[tuple, set] = {tuple(p.get(c) for c in choices): set() for p in flat}
        for p in flat:
            by_choice[tuple(p.get(c) for c in choices)].add(_hashable(p.get(key)))
        if all(len(values) == 1 for values in by_choice.values()):
            del kept[key]
    return kept


def _hashable(value: Any) -> Any:
    return value if isinstance(value, int | float | str) else json.dumps(value)


def collect(configs: list[RunConfig], store: Store, name: str | None = None) -> tuple[xr.Dataset, Path]:
    """All points in one dataset over what was swept, written to the store's `sweeps` folder.

    Metrics of another version are measured again from the stored fields. Points without a record are
    there as "missing". Returns the dataset and its file, `name` or a name made from the points.
    """
    swept = dimensions(configs)
    rows, attributes = [], {}
    for config in configs:
        flat = config.flat()
        row = {key: _hashable(flat.get(key)) for key in swept}
        run = _current(config, store)
        row["status"] = STATUS.index("missing") if run is None else int(run["status"])
        row["record"] = store.record_path(config).name
        row["message"] = "" if run is None else run.attrs["message"]
        if run is not None:
            for label, variable in run.data_vars.items():
                if variable.attrs.get("group") in ("metric", "cost"):
                    row[str(label)] = float(variable)
                    attributes[str(label)] = variable.attrs
        rows.append(row)
    dataset = _dataset(pd.DataFrame(rows), swept, attributes)
    dataset.attrs = {
        "Conventions": "CF-1.11",
        "title": f"sweep over {', '.join(swept)}",
        "source": "sphstudy, smoothed particle hydrodynamics of elastic solids",
        "configurations": json.dumps([c.as_dict() for c in configs], sort_keys=True),
        **provenance.provenance(),
    }
    path = store.folder / "sweeps" / f"{name or _name(configs)}.nc"
    write(dataset, path)
    return dataset, path


def _current(config: RunConfig, store: Store) -> xr.Dataset | None:
    """The record of a run with metrics of today's version."""
    run = store.read(config)
    if run is None or STATUS[int(run["status"])] != "done":
        return run
    if run.attrs["metrics_version"] != identity.metrics_version(config):
        run = measured(run, config)
        write(run, store.record_path(config))
    return run


def _dataset(table: pd.DataFrame, swept: dict[str, list[Any]], attributes: dict) -> xr.Dataset:
    index = pd.MultiIndex.from_frame(table[list(swept)])
    full = pd.MultiIndex.from_product(swept.values(), names=list(swept))
    status = table.pop("status").set_axis(index).reindex(full, fill_value=0)
    texts = {n: table.pop(n).set_axis(index).reindex(full, fill_value="") for n in ("record", "message")}
    numbers = table.drop(columns=list(swept)).set_axis(index, axis=0).reindex(full)
    shape = [len(values) for values in swept.values()]
    dims = list(swept)
    dataset = xr.Dataset(coords={key: (key, _coordinate(values)) for key, values in swept.items()})
    dataset["status"] = record.status_variable(dims, status.to_numpy().reshape(shape))
    for name, column in texts.items():
        meaning = {"record": "file of the record", "message": "what went wrong"}[name]
        values = column.to_numpy(dtype=object).reshape(shape)
        dataset[name] = (dims, values, {"units": "1", "long_name": meaning})
    for name in numbers:
        values = numbers[name].to_numpy(dtype=float).reshape(shape)
        dataset[name] = (dims, values, attributes[name])
    for key in swept:
        dataset[key].attrs = {"long_name": _meaning(key), "units": "1"}
    return dataset


def _coordinate(values: list[Any]) -> np.ndarray:
    return np.array(values, dtype=object if isinstance(values[0], str) else None)


def _meaning(key: str) -> str:
    return {"h": "relative smoothing radius", "n": "resolution"}.get(key, key)


def _name(configs: list[RunConfig]) -> str:
    """Scenes and methods for people, a hash of all points for certainty."""
    scenes = "+".join(dict.fromkeys(c.scene.name for c in configs))
    methods = "+".join(dict.fromkeys(c.method.name for c in configs))
    digest = hashlib.sha256(" ".join(sorted(identity.key(c) for c in configs)).encode())
    return f"{scenes}-{methods}-{digest.hexdigest()[:8]}"


def print_tables(dataset: xr.Dataset, configs: list[RunConfig]) -> None:
    """One table a scene: a line a point with outcome, the scene's headline metrics, and cost."""
    for scene in dict.fromkeys(config.scene.name for config in configs):
        _print_table(dataset, [config for config in configs if config.scene.name == scene])


def _print_table(dataset: xr.Dataset, configs: list[RunConfig]) -> None:
    swept = [str(dimension) for dimension in dataset["status"].dims]
    wanted = [*scene_module(configs[0].scene.kind).HEADLINE, "cpu_seconds", "steps", "particles"]
    columns = [name for name in wanted if name in dataset]
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for name in (*swept, "status", *columns):
        units = dataset[name].attrs.get("units", "1") if name in columns else "1"
        heading = name.replace("_", " ")
        table.add_column(heading if units == "1" else f"{heading} ({units})", justify="right")
    for config in sorted(configs, key=lambda c: _order(c, swept)):
        flat = config.flat()
        point = dataset.sel({key: _hashable(flat.get(key)) for key in swept})
        place = [f"{flat[key]:g}" if isinstance(flat[key], float) else str(flat[key]) for key in swept]
        table.add_row(*place, STATUS[int(point["status"])], *(_cell(float(point[c])) for c in columns))
    console = Console()
    if not console.is_terminal:
        console = Console(width=400)
    console.print(table)


def _order(config: RunConfig, swept: list[str]) -> tuple:
    """Sorts points by the swept keys: text before numbers, each in its own order."""
    values = (_hashable(config.flat().get(key)) for key in swept)
    return tuple((1, value) if isinstance(value, int | float) else (0, value) for value in values)


def _cell(value: float) -> str:
    if np.isnan(value):
        return "–"
    if value == int(value) and abs(value) < 1e15:
        return f"{int(value)}"
    return f"{value:.4g}"
