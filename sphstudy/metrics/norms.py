"""Error norms of displacement and stress against Williams' field, whole and away from frame and tip."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, snapshot
from sphstudy.model.exact import williams


class Norms(NamedTuple):
    """Norms of one field's error, over n particles, in the unit of the field (mean square: squared).

    rms: √(Σe²/n). mean_square: Σe²/n as (3.22, 3.23) print it. root_sum: √(Σe²)/n, which fits the axes of
    figures 4.13 and 4.17 best.
    """

    rms: float
    mean_square: float
    root_sum: float


def error_norms(computed: np.ndarray, exact: np.ndarray) -> Norms:
    """Norms of the error of a field.

    Parameters
    ----------
    computed, exact : array [n]
        The field at the particles, in one unit.

    Raises
    ------
    ValueError
        If there are no particles.
    """
    error = np.asarray(computed) - np.asarray(exact)
    if error.size == 0:
        raise ValueError("no particles to compare")
    total = float(np.sum(error**2))
    return Norms((total / error.size) ** 0.5, total / error.size, total**0.5 / error.size)


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Norms of u_x, u_y and the stresses in the settled state with crack length a."""
    scene, state = config.scene, snapshot(run, "settle")
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    computed = {"u_x": state["x"].values - x0, "u_y": state["y"].values - y0}
    computed |= {f"stress_{c}": state[f"stress_{c}"].values for c in ("xx", "yy", "xy")}
    displacement = williams.displacement(scene.mode, x0, y0, scene.K, scene.E, scene.nu)
    exact = (*displacement, *williams.stress(scene.mode, x0, y0, scene.K))
    inner = (run["tag_frame"].values == 0) & (run["tag_tip"].values == 0)
    metrics: dict[str, Metric] = {}
    for (name, values), reference in zip(computed.items(), exact, strict=True):
        unit = "m" if name.startswith("u_") else "Pa"
        squared = f"{unit}2"
        body = error_norms(values, reference)
        core = error_norms(values[inner], reference[inner])
        metrics |= {
            f"{name}_rms": Metric(body.rms, unit, f"rms error of {name}"),
            f"{name}_mean_square": Metric(body.mean_square, squared, f"(1/n) Σe² of {name}"),
            f"{name}_root_sum": Metric(body.root_sum, unit, f"(1/n) √Σe² of {name}"),
            f"{name}_rms_inner": Metric(
                core.rms, unit, f"rms error of {name}, without frame and tip disc"
            ),
        }
    return metrics
