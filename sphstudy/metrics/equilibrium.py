"""Whether a driven scene came to rest: how far √Σv² fell after loading, and in how many steps."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """√Σv² at the end of settling over its value at the end of loading, and the steps until the solver's
    ratio was reached; of a run that knew no time, nothing.
    """
    if float(run["time_step"]) == 0.0:
        return {}
    loaded = int(run["steps_load"])
    settled = loaded + int(run["steps_settle"])
    step, speed = run["history_step"].values, run["history_system_speed"].values
    after = (step >= loaded) & (step <= settled)
    if not after.any():
        after = np.arange(step.size) == step.size - 1
    threshold = config.solve.equilibrium_ratio
    fields = {str(label): k for k, label in enumerate(run["snapshot_label"].values)}
    at_load, at_rest = (_system_speed(run, fields[stage]) for stage in ("load", "settle"))
    ratio = speed[after] / at_load
    reached = np.flatnonzero(ratio <= threshold)
    steps = step[after][reached[0]] - loaded if reached.size else np.nan
    return {
        "equilibrium_ratio": pure(
            at_rest / at_load, "√Σv² at the end of settling over its value after loading"
        ),
        "equilibrium_reached": pure(
            at_rest / at_load <= threshold, f"1 if that ratio is at most {threshold:g}"
        ),
        "equilibrium_steps": pure(
            steps, f"steps after loading until the ratio first fell to {threshold:g}"
        ),
    }


def _system_speed(run: xr.Dataset, snapshot: int) -> float:
    state = run.isel(snapshot=snapshot)
    return float(np.sqrt((state["velocity_x"] ** 2 + state["velocity_y"] ** 2).sum()))
