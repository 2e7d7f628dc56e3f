"""Settings given from Python: what is swept, and what is one value."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.api import _overrides


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ([1.3, 1.5], "1.3,1.5"),
        (range(9, 22, 6), "9,15,21"),
        (np.linspace(1.3, 1.9, 3), "1.3,1.6,1.9"),
        (np.array(["thesis", "tl"]), "thesis,tl"),
        (xr.DataArray([5, 7], dims="n"), "5,7"),
        ([(0.5, 1.0), (2.0,)], "[0.5,1.0],[2.0]"),
        ((0.5, 1.0), "[0.5,1.0]"),
        (np.float64(1.5), "1.5"),
        ("plate", "plate"),
        (True, "True"),
        (None, "null"),
    ],
)
def test_any_sequence_but_a_tuple_is_swept(value, text):
    assert _overrides({"key": value}, swept=True) == [f"key={text}"]


def test_for_one_run_every_sequence_is_one_value():
    for value in ([0.5, 1.0], (0.5, 1.0), np.array([0.5, 1.0])):
        assert _overrides({"record.times": value}, swept=False) == ["record.times=[0.5,1.0]"]
