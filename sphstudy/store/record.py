"""One run as a labelled dataset: fields, history, metrics, cost, and where the numbers come from."""

import json
from typing import Any

import numpy as np
import xarray as xr

from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.metrics.metric import Metric
from sphstudy.model.problem import Problem
from sphstudy.numerics.solvers.solution import FIELDS, HISTORY, Solution

STATUS = ("missing", "done", "diverged", "failed", "timeout", "interrupted", "running")
"""Outcomes of a point; a record stores the position in this list."""

_FIELDS = {
    "x": ("m", "position, x"),
    "y": ("m", "position, y"),
    "velocity_x": ("m s-1", "velocity, x"),
    "velocity_y": ("m s-1", "velocity, y"),
    "density": ("kg m-3", "density"),
    "stress_xx": ("Pa", "stress, xx"),
    "stress_yy": ("Pa", "stress, yy"),
    "stress_xy": ("Pa", "stress, xy"),
}

_HISTORY = {
    "time": ("s", "time since the start of the run"),
    "step": ("1", "step number"),
    "u_x": ("m", "displacement of the tracked particle, x"),
    "u_y": ("m", "displacement of the tracked particle, y"),
    "system_speed": ("m s-1", "root of the sum of all squared velocities"),
    "momentum_x": ("kg s-1", "momentum per thickness, x"),
    "momentum_y": ("kg s-1", "momentum per thickness, y"),
    "angular_momentum": ("kg m s-1", "angular momentum per thickness about the origin"),
    "kinetic_energy": ("J m-1", "kinetic energy per thickness"),
    "strain_energy": ("J m-1", "strain energy per thickness: (3.18), or all of the potential"),
    "largest_speed": ("m s-1", "largest speed of a particle"),
    "smallest_spacing": ("m", "smallest distance between two particles that see each other"),
    "net_internal_force": ("1", "|sum of internal forces| over the sum of their magnitudes"),
    "constraint_power": ("W m-1", "power put in by the constraints per thickness"),
    "hourglass_share": ("1", "checkerboard share of the squared deformation of all lattice cells"),
    "hourglass_amplitude": ("1", "root mean square of the checkerboard, in spacings"),
    "mirror_defect": ("1", "largest distance from the mirror image, in spacings"),
}


def _variable(dims: Any, values: Any, units: str, long_name: str, **attributes: Any) -> tuple:
    return (dims, values, {"units": units, "long_name": long_name, **attributes})


def fields(problem: Problem, solution: Solution) -> xr.Dataset:
    """Reference configuration, snapshots and history of a run."""
    body, snapshots = problem.body, solution.snapshots
    particle, time = "particle", "snapshot"
    variables = {
        "reference_x": _variable(particle, body.x, "m", "reference position, x"),
        "reference_y": _variable(particle, body.y, "m", "reference position, y"),
        "mass": _variable(particle, body.mass, "kg m-1", "mass per thickness"),
        "constrained_x": _flags(body.x.size, problem.constraints.x_index, "held or driven in x"),
        "constrained_y": _flags(body.x.size, problem.constraints.y_index, "held or driven in y"),
        "spacing_x": _variable((), body.spacing_x, "m", "particle spacing, x"),
        "spacing_y": _variable((), body.spacing_y, "m", "particle spacing, y"),
        "snapshot_label": _variable(
            time, np.array([s.label for s in snapshots], dtype=object), "1", "stage or time"
        ),
        "snapshot_time": _variable(time, [s.time for s in snapshots], "s", "time of the snapshot"),
        "snapshot_step": _variable(time, [s.step for s in snapshots], "1", "step of the snapshot"),
        "snapshot_strain_energy": _variable(
            time, [s.strain_energy for s in snapshots], "J m-1", "strain energy per thickness"
        ),
        "snapshot_closure_work": _variable(
            time,
            [s.closure_work for s in snapshots],
            "J m-1",
            "half of forces of bonds cut in this stage times displacements at its end",
        ),
        "time_step": _variable((), solution.time_step, "s", "time step"),
    }
    for name, mask in body.tags.items():
        variables[f"tag_{name}"] = _flags(body.x.size, np.flatnonzero(mask), f"tag: {name}")
    state = np.array([s.fields for s in snapshots]).reshape(len(snapshots), len(FIELDS), body.x.size)
    for row, name in enumerate(FIELDS):
        variables[name] = _variable((time, particle), state[:, row], *_FIELDS[name])
    history = np.array(solution.history).reshape(-1, len(HISTORY))
    for column, name in enumerate(HISTORY):
        units, long_name = _HISTORY[name]
        variables["history_" + name] = _variable("sample", history[:, column], units, long_name)
    for name, steps in solution.stage_steps.items():
        variables[f"steps_{name}"] = _variable((), steps, "1", f"steps of stage {name}")
    for name, own in solution.variables.items():
        # Numbers go to tables beside metrics, as what they cost does.
        group = {} if own.dims else {"group": "cost"}
        variables[name] = _variable(own.dims, own.values, own.units, own.long_name, **group)
    return xr.Dataset(variables)


def _flags(count: int, index: np.ndarray, meaning: str) -> tuple:
    values = np.zeros(count, np.int8)
    values[index] = 1
    attributes = {"flag_values": np.array([0, 1], np.int8), "flag_meanings": "no yes"}
    return _variable("particle", values, "1", meaning, **attributes)


def with_metrics(run: xr.Dataset, metrics: dict[str, Metric], version: str) -> xr.Dataset:
    """The record with these metrics in place of whatever metrics it had."""
    old = [name for name in run.data_vars if run[name].attrs.get("group") == "metric"]
    run = run.drop_vars(old)
    for name, metric in metrics.items():
        run[name] = _variable((), float(metric.value), metric.units, metric.long_name, group="metric")
    run.attrs["metrics_version"] = version
    return run


def with_outcome(
    run: xr.Dataset, status: str, message: str, cost: dict[str, Metric], attributes: dict[str, str]
) -> xr.Dataset:
    """The record with its outcome, what it cost, and its provenance."""
    run["status"] = status_variable((), STATUS.index(status))
    for name, metric in cost.items():
        run[name] = _variable((), float(metric.value), metric.units, metric.long_name, group="cost")
    run.attrs = {
        "Conventions": "CF-1.11",
        "title": attributes.pop("title"),
        "source": "sphstudy, smoothed particle hydrodynamics of elastic solids",
        "message": message,
        **run.attrs,
        **attributes,
    }
    return run


def without_result(status: str, message: str, attributes: dict[str, str]) -> xr.Dataset:
    """The record of a run that left nothing but how it ended."""
    return with_outcome(xr.Dataset(), status, message, {}, attributes)


def status_variable(dims: Any, values: Any) -> tuple:
    """Status as CF flags."""
    return _variable(
        dims,
        np.asarray(values, np.int8),
        "1",
        "outcome of the run",
        flag_values=np.arange(len(STATUS), dtype=np.int8),
        flag_meanings=" ".join(STATUS),
    )


def configuration(run: xr.Dataset) -> RunConfig:
    """The configuration that a record carries."""
    return validate(json.loads(run.attrs["configuration"]))
