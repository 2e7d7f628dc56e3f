"""What a metric is, how all metrics of a run are measured, and what they read from its record."""

from typing import NamedTuple

import xarray as xr
from threadpoolctl import threadpool_limits

from sphstudy import catalogue
from sphstudy.model.problem import Body


class Metric(NamedTuple):
    """A number, its UDUNITS unit ("1": pure number) and what it is; `remark`: why it is not there."""

    value: float
    units: str
    long_name: str
    remark: str = ""


def pure(value: float, long_name: str, remark: str = "") -> Metric:
    """A metric that is a pure number."""
    return Metric(float(value), "1", long_name, remark)


def measure(run: xr.Dataset, config, modules: tuple[str, ...]) -> dict[str, Metric]:
    """All metrics of a record.

    Parameters
    ----------
    run : xarray.Dataset
        The record.
    config : RunConfig
        The configuration that it was computed with.
    modules : tuple of str
        Modules of `sphstudy.metrics`, by name; of metrics with the same name, the later one is kept.

    Raises
    ------
    ConfigurationError
        If there is no such module.
    """
    found: dict[str, Metric] = {}
    for name in modules:
        module = catalogue.module("metrics", name)
        # The last bits of what BLAS returns depend on its threads, which differ from worker to worker.
        # Only what is loaded by now is limited.
        with threadpool_limits(1):
            found |= module.measure(run, config)
    return found


def snapshot(run: xr.Dataset, label: str) -> xr.Dataset:
    """The fields of a record at one snapshot.

    Parameters
    ----------
    run : xarray.Dataset
        The record.
    label : str
        A stage, at its end, or a kept time such as "t=11".

    Raises
    ------
    KeyError
        If the record has no snapshot of that label.
    """
    labels = [str(value) for value in run["snapshot_label"].values]
    if label not in labels:
        raise KeyError(f"no snapshot {label!r} (there are {', '.join(labels)})")
    return run.isel(snapshot=labels.index(label))


def body(run: xr.Dataset, config) -> Body:
    """The body of a record in the reference configuration; without its lattice, which is not recorded."""
    tags = {str(n).removeprefix("tag_"): run[n].values == 1 for n in run if str(n).startswith("tag_")}
    x, y, mass = (run[name].values for name in ("reference_x", "reference_y", "mass"))
    spacings = float(run["spacing_x"]), float(run["spacing_y"])
    return Body(x, y, mass, *spacings, config.scene.material, tags)
