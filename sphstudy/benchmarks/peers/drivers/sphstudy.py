"""Vibrating plate by this program itself, in a process of its own like the peers.

python -P sphstudy.py settings.json: as the other drivers. CPU seconds are those of the record:
compilation is left out, setting up the run is counted.
"""

import json
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from sphstudy.configuration.composition import session
from sphstudy.running.one_run import computed
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store

WARM = 0.01
"""Periods of a first run, not counted, in which compiled code is fetched from its cache."""


def run(settings: dict) -> dict:
    """One run of the plate, or its modes."""
    overrides = {"scene": "plate", **settings["overrides"]}
    stepped = "scene.periods" in overrides
    _solved(overrides | ({"scene.periods": WARM, "record.samples": 10} if stepped else {}))
    found = _solved(overrides)
    outcome = {
        "cpu_seconds": float(found["cpu_seconds"]),
        "particles": int(found["particles"]),
        "versions": {"sphstudy": found.attrs["git_state"], "numba": _version(found, "numba")},
    }
    if "mode_frequency" in found:
        return outcome | {"frequency": float(found["frequency"])}
    sound = STATUS[int(found["status"])] == "done"
    return outcome | {
        "time": found["history_time"].values.tolist(),
        "deflection": found["history_u_y"].values.tolist(),
        "largest_speed": float(found["history_largest_speed"].values[-1]) if sound else None,
        "steps": int(found["steps"]),
        "time_step": float(found["time_step"]),
    }


def _solved(overrides: dict):
    """The record of a run in this process."""
    with session() as hydra, tempfile.TemporaryDirectory() as folder:
        points, _ = hydra.points([f"{key}={value}" for key, value in overrides.items()], sweep=False)
        store = Store(folder)
        store.prepare()
        return computed(points[0].config, store, replace(points[0].execution, checkpoint=1e9))


def _version(found, name: str) -> str:
    return dict(part.split(" ") for part in found.attrs["library_versions"].split(", "))[name]


if __name__ == "__main__":
    given = json.loads(Path(sys.argv[1]).read_text())
    Path(given["output"]).write_text(json.dumps(run(given)))
