"""The cells of a combined dataset, one by one, whether it is a grid or a list of points."""

import json
from dataclasses import dataclass
from typing import Any

import xarray as xr

from sphstudy.configuration.run_settings import flattened
from sphstudy.store.record import STATUS


@dataclass(frozen=True)
class Cell:
    """One point: its coordinates, its flat configuration, outcome, and numbers (metrics and cost)."""

    place: dict[str, Any]
    flat: dict[str, Any]
    status: str
    values: dict[str, float]

    @property
    def label(self) -> str:
        """The coordinates, for people."""
        return " ".join(f"{key}={shown(value)}" for key, value in self.place.items())


def cells(dataset: xr.Dataset, without: str = "") -> list[Cell]:
    """All points of a combined dataset; cells of a grid that are no point are left out.

    Parameters
    ----------
    dataset : xarray.Dataset
        The combined dataset.
    without : str
        Outcome of points that are left out too.

    Raises
    ------
    ValueError
        If it is not a combined dataset of this program.
    """
    if "configuration" not in dataset or "status" not in dataset:
        raise ValueError("not a combined dataset of this program")
    dims = dataset["status"].dims
    flat = dataset.stack(cell=dims) if len(dims) != 1 else dataset.rename({dims[0]: "cell"})
    places = [str(key) for key in dataset.coords]
    numbers = [str(n) for n, v in flat.data_vars.items() if v.dtype.kind == "f" and v.dims == ("cell",)]
    columns = {name: flat[name].values for name in (*places, *numbers)}
    found = []
    texts, outcomes = flat["configuration"].values, flat["status"].values
    for k, (text, outcome) in enumerate(zip(texts, outcomes, strict=True)):
        if text and (status := STATUS[int(outcome)]) != without:
            found.append(
                Cell(
                    {key: columns[key][k] for key in places},
                    flattened(json.loads(text)),
                    status,
                    {name: float(columns[name][k]) for name in numbers},
                )
            )
    return found


def shown(value: Any) -> str:
    """A setting as people write it."""
    return f"{value:g}" if isinstance(value, float) else str(value)
