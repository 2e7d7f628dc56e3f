"""Restoring force of a checkerboard, and the work it took to make it, against those of the solid."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure
from sphstudy.model.exact.waves import checkerboard_stiffness


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Mean stiffness over all particles, weighted with their squared displacements.

    At the end of loading: the power of the constraints over their rate is Σ F · target.
    """
    target = config.scene.displacements(config.n)
    squares = float(target @ target)
    physical = checkerboard_stiffness(config.scene.material)
    duration = float(run["steps_load"]) * float(run["time_step"])
    found = float(run["history_constraint_power"].values[-1]) * duration / squares
    time, power = run["history_time"].values, run["history_constraint_power"].values
    work = float(np.trapezoid(power, time))
    return {
        "restoring_stiffness": Metric(found, "Pa", "force per displacement and thickness on a particle"),
        "physical_stiffness": Metric(physical, "Pa", "the same in the solid, for the same plane wave"),
        "restoring_ratio": pure(found / physical, "restoring force over that of the solid"),
        "work_ratio": pure(
            work / (0.5 * physical * squares), "work of loading over that done on the solid"
        ),
    }
