"""Records and studies made up without running anything."""

import json

import numpy as np
import xarray as xr

from sphstudy import catalogue
from sphstudy.analysis import results
from sphstudy.metrics.metric import Metric
from sphstudy.numerics.solvers.solution import FIELDS, HISTORY, LAST_GOOD
from sphstudy.store import identity, record
from sphstudy.store.netcdf import write
from sphstudy.store.store import Store

SAMPLES = 11
MASS = np.array((1.0, 3.0))
ORIGIN = {
    "git_state": "0" * 40,
    "sphstudy_version": "1",
    "python_version": "3",
    "library_versions": "",
    "processor": "",
}


def made_up(config, status="done", metrics=None, message="", times=None, states=None, **history):
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
    found = {name: Metric(value, "1", name) for name, value in (metrics or {}).items()}
    run = record.with_metrics(run, found, identity.metrics_version(config))
    attributes = {"title": config.label, "configuration": json.dumps(config.as_dict()), **ORIGIN}
    attributes |= {"key": identity.key(config), "numerics_version": identity.numerics_version(config)}
    return record.with_outcome(run, status, message, {}, attributes | {"date_created": "2026-01-02"})


def load(folder, monkeypatch, hydra, text, make):
    """Results of a study of this text, with the record of each point that `make(flat, config)` gives."""
    (folder / "made_up.yaml").write_text(text)
    monkeypatch.setitem(catalogue.FOLDERS, "studies", folder)
    store = Store(folder / "results")
    empty = results.load("made_up", hydra, [], str(store.folder))
    for row in empty.table.index:
        config = empty.config_at(row)
        run = make(config.flat(), config)
        if run is not None:
            write(run, store.record_path(config))
    return results.load("made_up", hydra, [], str(store.folder))
