"""Energy balance on histories with known answers."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.metrics import balance


def record(kinetic, strain, power):
    """A history over one second."""
    columns = {
        "time": np.linspace(0.0, 1.0, len(kinetic)),
        "kinetic_energy": kinetic,
        "strain_energy": strain,
        "constraint_power": power,
        "net_internal_force": np.zeros(len(kinetic)),
        "smallest_spacing": np.full(len(kinetic), 0.09),
        "largest_speed": np.ones(len(kinetic)),
    }
    data = {f"history_{name}": ("sample", np.asarray(values, float)) for name, values in columns.items()}
    return xr.Dataset({**data, "spacing_x": 0.1, "spacing_y": 0.12, "time_step": 0.01})


def values(*columns):
    return {name: metric.value for name, metric in balance.measure(record(*columns), None).items()}


def test_energy_put_in_and_not_found_again():
    """3 J/m at the start, 1 J/m of work, 3.5 J/m found at the end and 2.4 of 3.5 in between."""
    found = values([3.0, 1.0, 1.5], [0.0, 1.4, 2.0], [1.0, 1.0, 1.0])
    assert found["external_work"] == pytest.approx(1.0)
    assert found["dissipated_energy"] == pytest.approx(0.5 / 4.0)
    assert found["energy_drift"] == pytest.approx(1.1 / 4.0)
    assert found["smallest_spacing"] == pytest.approx(0.9)


def test_where_there_is_no_energy_none_is_missing_and_any_is_too_much():
    nothing = [0.0, 0.0, 0.0]
    found = values(nothing, nothing, nothing)
    assert found["energy_drift"] == found["dissipated_energy"] == 0.0
    found = values(nothing, [0.0, 2.0, 1.0], nothing)
    assert found["energy_drift"] == pytest.approx(1.0)
    assert found["dissipated_energy"] == pytest.approx(-0.5)
