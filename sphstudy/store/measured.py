"""Metrics of a record, measured from its fields. Nothing is written."""

import xarray as xr

from sphstudy import catalogue
from sphstudy.catalogue import solver_module
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.metrics.metric import measure
from sphstudy.store import identity, record


def measured(run: xr.Dataset, config: RunConfig) -> xr.Dataset:
    """The record with today's metrics in place of those it has.

    Parameters
    ----------
    run : xarray.Dataset
        A record. If the run is done, remarks of its metrics become its message.
    config : RunConfig
        Its configuration.

    Returns
    -------
    xarray.Dataset
        The record; without metrics if the run is not done, or if its solver records numbers of its own
        (`HEADLINE`) and no motion.
    """
    metrics = {}
    own = hasattr(solver_module(config.solve.name), "HEADLINE")
    if record.STATUS[int(run["status"])] == "done" and not own:
        metrics = measure(run, config, catalogue.metrics(config.scene.name))
        remarks = [metric.remark for metric in metrics.values() if metric.remark]
        run.attrs["message"] = "; ".join(dict.fromkeys(remarks))
    return record.with_metrics(run, metrics, identity.metrics_version(config))


def up_to_date(run: xr.Dataset, config: RunConfig) -> xr.Dataset:
    """The record itself if it is not done or its metrics are of today's version, else `measured`."""
    done = record.STATUS[int(run["status"])] == "done"
    current = run.attrs.get("metrics_version") == identity.metrics_version(config)
    return measured(run, config) if done and not current else run
