"""A spinning square: its angular momentum, how fast it turns, how far it swells, if it stays square."""

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure
from sphstudy.model.exact.spinning_square import spinning_square


def fourfold_defect(place: np.ndarray, n: int) -> float:
    """Largest distance between a particle and the image of its partner under a quarter turn.

    Parameters
    ----------
    place : array [2, n · n]
        Positions of the particles of a square, row by row; the turn is about their centre.
    n : int
        Particles along a side.

    Returns
    -------
    float
        Distance, in the unit of the positions.
    """
    x, y = (place - place.mean(axis=1, keepdims=True)).reshape(2, n, n)
    # The particle of column c and row r comes to column n-1-r and row c: from (x, y) to (-y, x).
    image_x, image_y = -y.T[:, ::-1], x.T[:, ::-1]
    return float(np.hypot(x - image_x, y - image_y).max())


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """From the history: angular momentum, and the path of the tracked corner. From the last state: the
    fourfold symmetry, which elasticity keeps. Of modes, nothing.
    """
    if not run.sizes.get("sample"):
        return {}
    scene = config.scene
    momentum = run["history_angular_momentum"].values
    corner = np.array(
        [float(run[f"reference_{axis}"].values[-1]) + run[f"history_u_{axis}"].values for axis in "xy"]
    )
    radius, angle = np.hypot(*corner), np.unwrap(np.arctan2(corner[1], corner[0]))
    rate = float(np.polyfit(run["history_time"].values, angle, 1)[0])
    steady = spinning_square(scene.L, scene.rate, scene.material)
    # To first order: the rate goes as J/I, and a sudden load swings about the state of a slow one.
    expected = scene.rate * (1.0 - steady.inertia_gain.value)
    spacing, last = float(run["spacing_x"]), run.isel(snapshot=-1)
    return {
        "angular_momentum_drift": pure(
            np.abs(momentum / momentum[0] - 1.0).max(), "largest relative change of angular momentum"
        ),
        "turns": pure(float(angle[-1] - angle[0]) / (2.0 * np.pi), "turns of the tracked corner"),
        "rate": Metric(rate, "rad s-1", "angular velocity of the tracked corner, least squares"),
        "rate_error": pure(rate / expected - 1.0, "relative error of the rate against linear elasticity"),
        "corner_stretch_largest": pure(
            float(radius.max() / radius[0]) - 1.0, "largest relative gain of a corner's distance"
        ),
        "corner_stretch_smallest": pure(
            float(radius.min() / radius[0]) - 1.0, "smallest relative gain of a corner's distance"
        ),
        "corner_stretch_mean_error": pure(
            float(radius.mean() / radius[0] - 1.0) / steady.corner_stretch.value - 1.0,
            "relative error of a corner's mean gain against steady rotation in linear elasticity",
        ),
        "fourfold_defect": pure(
            fourfold_defect(np.stack((last["x"].values, last["y"].values)), config.n) / spacing,
            "largest distance from the image under a quarter turn, over Δ, at the end",
        ),
    }
