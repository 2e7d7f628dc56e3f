"""Restoring force of a checkerboard, from a record of springs of known stiffness."""

from functools import cache

import numpy as np
import pytest
import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.metrics import checkerboard
from sphstudy.model.scenes.checkerboard import pattern

LAME_AND_SHEAR = 1e6 * 0.3 / (1.3 * 0.4) + 3.0 * 1e6 / 2.6
"""λ + 3µ of the scene's material."""


@cache
def configured(n):
    with session() as hydra:
        return hydra.points(["scene=checkerboard", f"n={n}"], sweep=False)[0][0].config


def record(share, viscous=0.0, n=12, duration=3.0):
    """Every particle on a spring of this share of the physical stiffness, driven in `duration` (s), with
    so much of the last force as friction; and the configuration.
    """
    config = configured(n)
    squares = float(((0.05 / n * pattern(n)) ** 2).sum())
    time = np.linspace(0.0, duration, 101)
    force = share * LAME_AND_SHEAR * np.pi**2 * squares * (time / duration + viscous)
    return xr.Dataset(
        {
            "history_time": ("sample", time),
            "history_constraint_power": ("sample", force / duration),
            "spacing_x": 1.0 / n,
            "steps_load": 600,
            "time_step": duration / 600,
        }
    ), config


@pytest.mark.parametrize(("share", "duration"), [(1.0, 3.0), (0.06, 3.0), (0.06, 50.0), (-0.2, 3.0)])
def test_springs_are_found(share, duration):
    found = checkerboard.measure(*record(share, duration=duration))
    assert found["physical_stiffness"].value == pytest.approx(LAME_AND_SHEAR * np.pi**2)
    assert found["restoring_ratio"].value == pytest.approx(share)
    assert found["restoring_stiffness"].value == pytest.approx(share * LAME_AND_SHEAR * np.pi**2)
    assert found["work_ratio"].value == pytest.approx(share)


def test_friction_shows_as_work_beyond_half_of_force_times_way():
    found = checkerboard.measure(*record(0.1, viscous=0.5))
    assert found["restoring_ratio"].value == pytest.approx(0.15)
    assert found["work_ratio"].value == pytest.approx(0.2)
