"""Metrics of a record, measured from its fields."""

import xarray as xr

from sphstudy import catalogue
from sphstudy.catalogue import solver_module
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.metrics.metric import measure
from sphstudy.store import identity, record


def measured(run: xr.Dataset, config: RunConfig) -> xr.Dataset:
    """The record with its metrics, measured from its fields; none if the run is not done, or if its
    solver leaves numbers of its own (`HEADLINE`) and no motion.

    What metrics remark is the message of a run that is done.
    """
    metrics = {}
    own = hasattr(solver_module(config.solve.name), "HEADLINE")
    if record.STATUS[int(run["status"])] == "done" and not own:
        metrics = measure(run, config, catalogue.metrics(config.scene.name))
        remarks = [metric.remark for metric in metrics.values() if metric.remark]
        run.attrs["message"] = "; ".join(dict.fromkeys(remarks))
    return record.with_metrics(run, metrics, identity.metrics_version(config))
