"""The combined dataset: all points of a sweep in one labelled dataset over what was swept."""

import hashlib
import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from sphstudy.analysis.dimensions import dimensions, hashable
from sphstudy.analysis.points_table import ORIGIN, points_table
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.store import identity, netcdf, provenance, record
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store
from sphstudy.store.summary import Summary
from sphstudy.text import short_name

SPARSEST = 8
"""If a full grid would have more than this many cells per point, the dataset is a list of points."""

_TEXTS = {
    "record": "file of the record",
    "message": "what went wrong",
    "configuration": "resolved configuration of the run, JSON",
}


def combine(
    configs: list[RunConfig],
    store: Store,
    study: str = "STUDY",
    known: list[Summary | None] | None = None,
) -> xr.Dataset:
    """All points in one dataset, points without a record as "missing". Nothing is written.

    Parameters
    ----------
    configs : list of RunConfig
        The points.
    store : Store
        Where their records are.
    study : str
        The study that they belong to, for the line about metrics of an older version.
    known : list of Summary, optional
        Summaries of their records that have been read already; None for the others.

    Returns
    -------
    xarray.Dataset
        Its dimensions are the swept settings; or the one dimension `point`, with the swept settings as
        coordinates along it, if the points fill less than an eighth of the full grid.
    """
    flat = [config.flat() for config in configs]
    swept = dimensions(flat)
    stored = points_table(configs, store, study, known)
    table = pd.DataFrame(stored.rows).drop(columns=[key for key in ORIGIN if key != "message"])
    table["configuration"] = [config.text for config in configs]
    places = pd.DataFrame([{key: hashable(point.get(key)) for key in swept} for point in flat])
    arrange = _list if math.prod(map(len, swept.values())) > SPARSEST * len(configs) else _grid
    dataset = arrange(table, places, swept, stored.attributes)
    dataset.attrs = {
        "Conventions": "CF-1.11",
        "title": f"sweep over {', '.join(swept)}",
        "source": "sphstudy, smoothed particle hydrodynamics of elastic solids",
        **provenance.provenance(),
    }
    return dataset


def write(dataset: xr.Dataset, configs: list[RunConfig], store: Store, name: str | None = None) -> Path:
    """Writes a combined dataset to the store's `sweeps` folder.

    Parameters
    ----------
    dataset : xarray.Dataset
        What `combine` made of the points.
    configs : list of RunConfig
        The points.
    store : Store
        Where it is written.
    name : str, optional
        Name of the file without its ending; made from the points if not given.

    Returns
    -------
    Path
        The file.
    """
    path = store.dataset_path(name or _name(configs))
    netcdf.write(dataset, path)
    return path


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


def _list(
    table: pd.DataFrame, places: pd.DataFrame, swept: dict[str, list[Any]], attributes: dict
) -> xr.Dataset:
    """The points one after the other."""
    coordinates = {key: ("point", _coordinate(places[key].tolist())) for key in swept}
    return _dataset(table, ["point"], [len(table)], coordinates, attributes)


def _dataset(
    table: pd.DataFrame, dims: list[str], shape: list[int], coordinates: dict, attributes: dict
) -> xr.Dataset:
    dataset = xr.Dataset(coords=coordinates)
    meanings = {"h": "relative smoothing radius", "n": "resolution"}
    for key in coordinates:
        dataset[key].attrs = {"long_name": meanings.get(key, key), "units": "1"}
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


def _coordinate(values: list[Any]) -> np.ndarray:
    if all(isinstance(value, int | float) for value in values):
        return np.array(values)
    return np.array([str(value) for value in values], dtype=object)


def _name(configs: list[RunConfig]) -> str:
    """Scenes and methods for people, a hash of all points for certainty."""
    scenes = "+".join(dict.fromkeys(c.scene.name for c in configs))
    methods = "+".join(dict.fromkeys(c.method.name for c in configs))
    digest = hashlib.sha256(" ".join(sorted(identity.key(c) for c in configs)).encode())
    return f"{short_name(f'{scenes}-{methods}')}-{digest.hexdigest()[:8]}"
