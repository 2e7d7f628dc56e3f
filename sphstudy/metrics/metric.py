"""What a metric is, and how all metrics of a run are measured."""

from typing import NamedTuple

import xarray as xr
from threadpoolctl import threadpool_limits

from sphstudy import catalogue


class Metric(NamedTuple):
    """A number, its UDUNITS unit ("1": pure number) and what it is; `remark`: why it is not there."""

    value: float
    units: str
    long_name: str
    remark: str = ""


def measure(run: xr.Dataset, config, modules: tuple[str, ...]) -> dict[str, Metric]:
    """All metrics of the named modules of `sphstudy.metrics`, for one record."""
    found: dict[str, Metric] = {}
    for name in modules:
        module = catalogue.module("metrics", name)
        # The last bits of what BLAS returns depend on its threads, which differ from worker to worker.
        # Only what is loaded by now is limited.
        with threadpool_limits(1):
            found |= module.measure(run, config)
    return found


def snapshot(run: xr.Dataset, label: str) -> xr.Dataset:
    """The fields of a record at the snapshot of that label. Raises KeyError if there is none."""
    labels = [str(value) for value in run["snapshot_label"].values]
    if label not in labels:
        raise KeyError(f"no snapshot {label!r} (there are {', '.join(labels)})")
    return run.isel(snapshot=labels.index(label))
