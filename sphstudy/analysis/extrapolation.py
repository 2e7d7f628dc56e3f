"""Metrics of a combined dataset extrapolated over its resolutions.

Orders are fitted in the particle spacing Δ (m) that each record carries, never in n; `richardson.py` says
how, and how uncertain the results are.
"""

import difflib
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from sphstudy.analysis.cells import Cell, cells
from sphstudy.analysis.richardson import Extrapolation, extrapolate
from sphstudy.errors import ConfigurationError


@dataclass(frozen=True)
class Series:
    """A metric over the resolutions of points that agree in everything else.

    Attributes
    ----------
    scene : str
        Name of the scene.
    place : dict
        Coordinates other than n.
    values : dict
        The metric by n; NaN where the point is left out, for the reason in the extrapolation's flag.
    extrapolation : Extrapolation
        To zero spacing.
    """

    scene: str
    place: dict[str, Any]
    values: dict[int, float]
    extrapolation: Extrapolation


def series(dataset: xr.Dataset, metric: str, order: float | None = None) -> list[Series]:
    """The extrapolation of a metric of a combined dataset for each group of points that differ in n only.

    Parameters
    ----------
    dataset : xarray.Dataset
        The combined dataset.
    metric : str
        One of its metrics.
    order : float, optional
        Order of convergence; observed if not given.

    Raises
    ------
    ConfigurationError
        If the dataset is not a combined one, or lacks the metric, the particle spacing, or a second n.
    """
    _check(dataset, metric)
    groups: dict[tuple, list[Cell]] = {}
    for cell in cells(_with_dimensions(dataset)):
        groups.setdefault(tuple(v for key, v in cell.place.items() if key != "n"), []).append(cell)
    return [
        _series(sorted(group, key=lambda c: c.place["n"]), metric, order) for group in groups.values()
    ]


def _series(group: list[Cell], metric: str, order: float | None) -> Series:
    left_out = {cell.place["n"]: why for cell in group if (why := _complaint(cell, metric))}
    good = [cell for cell in group if cell.place["n"] not in left_out]
    found = extrapolate([c.values["spacing"] for c in good], [c.values[metric] for c in good], order)
    if left_out:
        told = "left out: " + ", ".join(f"n={n} {why}" for n, why in left_out.items())
        found = replace(found, flag="; ".join(filter(None, [found.flag, told])))
    values = {int(c.place["n"]): c.values[metric] if c in good else math.nan for c in group}
    place = {key: value for key, value in group[0].place.items() if key != "n"}
    return Series(group[0].flat["scene"], place, values, found)


def _complaint(cell: Cell, metric: str) -> str:
    """Why a point is left out, "" if it is not."""
    if cell.status != "done":
        return cell.status
    if not math.isfinite(cell.values[metric]):
        return "without a value"
    return "" if cell.values["spacing"] > 0.0 else "without a spacing"


def extrapolated(dataset: xr.Dataset, metric: str, order: float | None = None) -> xr.Dataset:
    """A metric of a combined dataset at zero spacing, over all that was swept besides n.

    Parameters and errors are those of `series`.

    Returns
    -------
    xarray.Dataset
        The metric and METRIC_uncertainty (both in its unit), METRIC_order and METRIC_flag.
    """
    found = series(dataset, metric, order)
    dataset = _with_dimensions(dataset)
    dims = [str(dim) for dim in dataset["status"].dims if dim != "n"]
    if "n" in dataset["status"].dims:
        coordinates: dict[str, Any] = {dim: dataset[dim] for dim in dims}
        # A cell that is no point has no series.
        places = [tuple(list(dataset[d].values).index(s.place[d]) for d in dims) for s in found]
    else:
        keys = [str(key) for key in dataset.coords if key != "n"]
        columns = {key: np.array([s.place[key] for s in found], dataset[key].dtype) for key in keys}
        coordinates = {key: (dims, column, dataset[key].attrs) for key, column in columns.items()}
        places = [(k,) for k in range(len(found))]
    result = xr.Dataset(coords=coordinates)
    shape = [result.sizes[dim] for dim in dims]
    units, meaning = (dataset[metric].attrs.get(key, "") for key in ("units", "long_name"))
    for name, part, unit, text in (
        (metric, "value", units, f"{meaning}, extrapolated to zero particle spacing"),
        (f"{metric}_uncertainty", "uncertainty", units, "uncertainty of the extrapolation"),
        (f"{metric}_order", "order", "1", f"{'observed' if order is None else 'given'} order"),
        (f"{metric}_flag", "flag", "1", "what is to be said about the extrapolation"),
    ):
        values = np.full(shape, "", object) if part == "flag" else np.full(shape, math.nan)
        for place, one in zip(places, found, strict=True):
            values[place] = getattr(one.extrapolation, part)
        result[name] = (dims, values, {"units": unit, "long_name": text})
    return result.assign_attrs(
        dataset.attrs, title=f"extrapolation over n: {dataset.attrs.get('title', '')}"
    )


def extrapolated_together(
    dataset: xr.Dataset, metrics: list[str], order: float | None = None
) -> xr.Dataset:
    """Several metrics, each as `extrapolated` gives it, in one dataset."""
    result = xr.Dataset()
    for metric in metrics:
        one = extrapolated(dataset, metric, order)
        result = result.assign(one.data_vars).assign_attrs(one.attrs)
    return result


def _with_dimensions(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with what has been selected (h=1.5) as a dimension again."""
    return dataset.expand_dims([key for key, c in dataset.coords.items() if c.ndim == 0])


def _check(dataset: xr.Dataset, metric: str) -> None:
    if {"configuration", "status", "h"} - set(dataset.variables):
        raise ConfigurationError(["not a combined dataset of this program"])
    if "n" not in dataset.coords or (count := np.unique(dataset["n"]).size) < 2:
        has = "no n" if "n" not in dataset.coords else f"{count} value of n"
        raise ConfigurationError([f"n: the dataset has {has}, an extrapolation takes two or more"])
    metrics = [str(name) for name, v in dataset.data_vars.items() if v.attrs.get("group") == "metric"]
    if metric not in metrics:
        close = difflib.get_close_matches(metric, metrics, n=3, cutoff=0.5)
        hint = f"did you mean {' or '.join(close)}?" if close else f"there are {', '.join(metrics)}"
        raise ConfigurationError([f"{metric}: there is no such metric; {hint}"])
    if "spacing" not in dataset:
        raise ConfigurationError(["spacing: the dataset lacks the particle spacings (m) of its points"])
