"""The program from Python: the same runs, records and datasets as on the command line."""

from typing import Any

import numpy as np
import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.running import sweep as sweeps
from sphstudy.store.measured import up_to_date
from sphstudy.store.netcdf import read_dataset
from sphstudy.store.store import Store


def run(**settings: Any) -> xr.Dataset:
    """One run, from the store if it is there: `run(scene="plate", h=1.5, n=21)`.

    Parameters
    ----------
    **settings
        Settings of the run; those with a dot come from a dictionary: `run(**{"scene.nu": 0.4})`.

    Returns
    -------
    xarray.Dataset
        The record with fields, history, metrics and cost.

    Raises
    ------
    ConfigurationError
        On wrong input.
    """
    with session() as hydra:
        points, folder = hydra.points(_overrides(settings, swept=False), sweep=False)
        store, config = Store(folder), points[0].config
        sweeps.sweep(hydra, points, store, launcher=[])
        record = store.read(config)
    if record is None:
        raise RuntimeError(f"the record of {config.label} is not there")
    return up_to_date(record, config)


def sweep(**settings: Any) -> xr.Dataset:
    """All combinations of several values: `sweep(h=[1.3, 1.5], n=range(40, 61, 10))`.

    Parameters
    ----------
    **settings
        As those of `run`; a list, a range or an array of one dimension is swept. A setting that is
        itself a list is written as a tuple.

    Returns
    -------
    xarray.Dataset
        The combined dataset over what was swept.

    Raises
    ------
    ConfigurationError
        On wrong input.
    """
    with session() as hydra:
        points, folder = hydra.points(_overrides(settings, swept=True), sweep=True)
        return sweeps.sweep(hydra, points, Store(folder), launcher=[])[0]


def open(name: str, results: str = "results") -> xr.Dataset:
    """The combined dataset of a study or sweep.

    Parameters
    ----------
    name : str
        Of the study or sweep, or of a file.
    results : str
        Folder of the results.

    Raises
    ------
    ConfigurationError
        If there is none.
    """
    return read_dataset(name, results)


def _overrides(settings: dict[str, Any], swept: bool) -> list[str]:
    return [f"{key}={_text(value, swept)}" for key, value in settings.items()]


def _text(value: Any, swept: bool) -> str:
    if hasattr(value, "__array__"):
        value = np.asarray(value).tolist()
    if isinstance(value, list | range) and swept:
        return ",".join(_text(item, False) for item in value)
    if isinstance(value, list | tuple | range):
        return f"[{','.join(_text(item, False) for item in value)}]"
    return "null" if value is None else str(value)
