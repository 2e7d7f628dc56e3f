"""The program from Python: the same runs, records and datasets as on the command line."""

from typing import Any

import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.running import sweep as batch
from sphstudy.store.measured import up_to_date
from sphstudy.store.netcdf import read_dataset
from sphstudy.store.store import Store


def run(**settings: Any) -> xr.Dataset:
    """One run, from the store if it is there: run(scene="plate", h=1.5, n=21).

    Dotted keys go into a dictionary: run(**{"scene.nu": 0.4}). Returns the record with fields, history,
    metrics and cost. Raises ConfigurationError on wrong input.
    """
    with session() as hydra:
        points, folder = hydra.points(_overrides(settings, swept=False), sweep=False)
        store = Store(folder)
        batch.sweep(hydra, points, store, launcher=[])
        config = points[0].config
        record = store.read(config)
    if record is None:
        raise RuntimeError(f"the record of {config.label} is not there")
    return up_to_date(record, config)


def sweep(**settings: Any) -> xr.Dataset:
    """All combinations, a list meaning several values: sweep(h=[1.3, 1.5], n=[40, 50]).

    Returns the combined dataset over what was swept. A setting that is itself a list is written as a
    tuple. Raises ConfigurationError on wrong input.
    """
    with session() as hydra:
        points, folder = hydra.points(_overrides(settings, swept=True), sweep=True)
        dataset, _ = batch.sweep(hydra, points, Store(folder), launcher=[])
    return dataset


def open(name: str, results: str = "results") -> xr.Dataset:
    """The combined dataset of a study or sweep, by name or file.

    Raises ConfigurationError if there is none.
    """
    return read_dataset(name, results)


def _overrides(settings: dict[str, Any], swept: bool) -> list[str]:
    return [f"{key}={_text(value, swept)}" for key, value in settings.items()]


def _text(value: Any, swept: bool) -> str:
    if isinstance(value, list) and swept:
        return ",".join(_text(item, False) for item in value)
    if isinstance(value, list | tuple):
        return f"[{','.join(_text(item, False) for item in value)}]"
    return "null" if value is None else str(value)
