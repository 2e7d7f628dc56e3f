"""Records made up without running anything."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric
from sphstudy.numerics.solvers.solution import FIELDS, HISTORY, LAST_GOOD
from sphstudy.store import identity
from sphstudy.store.record import with_metrics, with_outcome

SAMPLES = 11
MASS = np.array((1.0, 3.0))
ORIGIN = {
    "git_state": "0123456789abcdef0123456789abcdef01234567 (dirty)",
    "sphstudy_version": "9.8.7",
    "python_version": "3.12",
    "library_versions": "numpy 2.0",
    "processor": "Abacus",
    "operating_system": "none",
}


def record(config, status="done", message="", metrics=None, cost=None, fields=None):
    """The record of a point: metrics {name: value}, cost {name: (value, unit)}, fields: a Dataset."""
    numbers = {name: Metric(value, "1", name) for name, value in (metrics or {}).items()}
    run = xr.Dataset() if fields is None else fields
    run = with_metrics(run, numbers, identity.metrics_version(config))
    spent = {name: Metric(value, unit, name) for name, (value, unit) in (cost or {}).items()}
    attributes = {
        "title": config.label,
        "configuration": config.text,
        "key": identity.key(config),
        "numerics_version": identity.numerics_version(config),
    }
    run = with_outcome(run, status, message, spent, attributes | ORIGIN)
    run.attrs["date_created"] = "2026-01-02T03:04:05Z"
    return run


def two_particles(config, status="done", metrics=None, message="", times=None, states=None, **history):
    """A record of two particles 1 m apart, sampled each second; `states`: time and places [2, 2] of its
    snapshots, the last of a diverged run its last good one. At rest, unless `history` says otherwise.
    """
    time = np.arange(float(SAMPLES)) if times is None else times
    columns = dict.fromkeys(HISTORY, np.zeros(time.size)) | {"time": time}
    columns |= {"strain_energy": np.ones(time.size), "smallest_spacing": np.ones(time.size)}
    states = states or [(0.0, np.eye(2)), (10.0, np.eye(2))]
    labels = [f"t={when:g}" for when, _ in states]
    labels[-1] = LAST_GOOD if status == "diverged" else "run"
    run = xr.Dataset(
        {
            "reference_x": ("particle", [0.0, 1.0]),
            "reference_y": ("particle", [0.0, 0.0]),
            "mass": ("particle", MASS),
            "spacing_x": 1.0,
            "spacing_y": 1.25,
            "time_step": 0.1,
            "snapshot_label": ("snapshot", np.array(labels, dtype=object)),
            "snapshot_time": ("snapshot", [when for when, _ in states]),
        }
    )
    fields = np.zeros((len(states), len(FIELDS), 2))
    fields[:, :2] = [places for _, places in states]
    fields[:, FIELDS.index("stress_xx")] = 2e3 + np.arange(len(states))[:, None]
    for k, name in enumerate(FIELDS):
        run[name] = (("snapshot", "particle"), fields[:, k])
    for name, values in (columns | history).items():
        run[f"history_{name}"] = ("sample", values)
    return record(config, status, message, metrics, fields=run)
