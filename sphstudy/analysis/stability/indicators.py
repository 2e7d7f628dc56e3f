"""Signs of a run going bad, sample by sample, each scaled so that runs of all scenes compare."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from sphstudy.model.material import Material
from sphstudy.numerics.solvers.limits import energies
from sphstudy.store.record import configuration


def wave_speed(run: xr.Dataset) -> float:
    """c0 (m/s) of a record's material."""
    scene = configuration(run).scene
    return Material(scene.E, scene.nu, scene.rho, scene.plane).wave_speed


def measure(run: xr.Dataset, name: str) -> np.ndarray:
    """An indicator of a record at each sample.

    Parameters
    ----------
    run : xarray.Dataset
        The record.
    name : str
        Key of INDICATORS.

    Returns
    -------
    array [S]
        Values (1); NaN where the scene has nothing to measure.
    """
    return INDICATORS[name][1](run)


def _history(run: xr.Dataset, name: str) -> np.ndarray:
    return run[f"history_{name}"].values


def _energy_gain(run: xr.Dataset) -> np.ndarray:
    """Over the most energy put in during the whole run: early on, little has been put in, and samples do
    not give the work of the constraints accurately enough.
    """
    columns = ("time", "kinetic_energy", "strain_energy", "constraint_power")
    found, put_in = energies(*(_history(run, name) for name in columns))
    most = np.abs(put_in).max()
    return (found - put_in) / most if most > 0.0 else np.zeros_like(found)


def _momentum_drift(run: xr.Dataset) -> np.ndarray:
    """Σ m |v| is at most √(2 M E_k), with equality where all particles are equally fast."""
    x, y = (_history(run, f"momentum_{axis}") for axis in "xy")
    return _drift(run, np.hypot(x - x[0], y - y[0]), run["mass"].values)


def _angular_momentum_drift(run: xr.Dataset) -> np.ndarray:
    """|L| is at most √(2 I E_k), with equality where the body spins about the origin as a rigid one."""
    inertia = run["mass"].values * (run["reference_x"].values ** 2 + run["reference_y"].values ** 2)
    momentum = _history(run, "angular_momentum")
    return _drift(run, np.abs(momentum - momentum[0]), inertia)


def _drift(run: xr.Dataset, change: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    fastest = np.maximum.accumulate(_history(run, "kinetic_energy"))
    scale = np.sqrt(2.0 * inertia.sum() * fastest)
    return np.divide(change, scale, out=np.zeros_like(change), where=scale > 0.0)


def _smallest_spacing(run: xr.Dataset) -> np.ndarray:
    return _history(run, "smallest_spacing") / min(float(run["spacing_x"]), float(run["spacing_y"]))


def _speed(run: xr.Dataset) -> np.ndarray:
    return _history(run, "largest_speed") / wave_speed(run)


def _kept(name: str) -> Callable[[xr.Dataset], np.ndarray]:
    return lambda run: _history(run, name)


INDICATORS: dict[str, tuple[str, Callable[[xr.Dataset], np.ndarray]]] = {
    "energy_gain": ("energy found less energy put in, over the most put in", _energy_gain),
    "energy_error": ("size of the same", lambda run: np.abs(_energy_gain(run))),
    "momentum_drift": ("change of momentum over √(2 M E_k)", _momentum_drift),
    "angular_momentum_drift": ("change of angular momentum over √(2 I E_k)", _angular_momentum_drift),
    "smallest_spacing": ("smallest distance of two particles, in initial spacings", _smallest_spacing),
    "speed": ("largest speed of a particle over c0", _speed),
    "hourglass_share": ("checkerboard share of the squared deformation", _kept("hourglass_share")),
    "hourglass_amplitude": ("rms of the checkerboard, in spacings", _kept("hourglass_amplitude")),
    "mirror_defect": ("largest distance from the mirror image, in spacings", _kept("mirror_defect")),
}
"""What each indicator is, and how it follows from a record."""
