"""Checkerboards and stripes in a pressure, on fields with known ones."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.metrics import pressure
from sphstudy.metrics.pressure import checkerboard_share, stripe_share

ROWS, COLUMNS = np.meshgrid(np.arange(5.0), np.arange(60.0), indexing="ij")
BOARD = (-1.0) ** (ROWS + COLUMNS)


def test_all_of_a_checkerboard_and_nothing_of_a_plane_is_checkerboard():
    assert checkerboard_share(3.0 * BOARD) == pytest.approx(1.0)
    assert checkerboard_share(7.0 + 2.0 * ROWS - 5.0 * COLUMNS) == pytest.approx(0.0, abs=1e-14)


def test_stripes_are_no_checkerboard():
    for stripes in ((-1.0) ** ROWS, (-1.0) ** COLUMNS):
        assert checkerboard_share(stripes) == pytest.approx(0.0, abs=1e-14)


def test_rows_that_alternate_are_stripes_and_columns_or_a_bending_pressure_are_not():
    assert stripe_share(2.0 * (-1.0) ** ROWS) == pytest.approx(1.0)
    for smooth in ((-1.0) ** COLUMNS, (ROWS - 2.0) * (60.0 - COLUMNS) ** 2):
        assert stripe_share(smooth) == pytest.approx(0.0, abs=1e-14)


def test_the_share_is_of_the_field():
    bending = (ROWS - 2.0) * (60.0 - COLUMNS)
    share = checkerboard_share(bending + 0.5 * BOARD)
    size = np.sqrt(np.mean(bending**2))
    # A quarter of the mixed difference of y (L - x) is a quarter, beside the half put in.
    assert share == pytest.approx(np.sqrt(0.5**2 + 0.25**2) / size, rel=0.02)


def test_a_smooth_field_shows_less_of_it_the_finer_the_lattice():
    def smooth(n):
        x, y = np.meshgrid(np.linspace(0.0, 1.0, 12 * n), np.linspace(-1.0, 1.0, n))
        return checkerboard_share(y * (1.0 - x) ** 2)

    assert smooth(10) < 0.01
    assert smooth(20) == pytest.approx(smooth(10) / 4.0, rel=0.15)


def test_nothing_has_no_share():
    assert np.isnan(checkerboard_share(np.zeros((3, 4))))
    assert np.isnan(stripe_share(np.zeros((3, 4))))


def record():
    """A plate at first, with its tip up, and at the end, with checkerboards of 0.1, 0.2 and 0.3."""
    with session() as hydra:
        config = hydra.points(["scene=incompressible", "method=tl", "n=5"], sweep=False)[0][0].config
    time = np.linspace(0.0, 6.0, 61)
    fields = np.stack([(1.0 + share * BOARD).ravel() for share in (0.1, 0.2, 0.3)])
    column = np.tile(np.arange(60) / 59.75, 5)
    # What stands within a height of the wall, 1/12, is not looked at.
    fields[:, column < 1.0 / 12.0] *= 100.0 * column[column < 1.0 / 12.0]
    run = xr.Dataset(
        {
            "reference_x": ("particle", column),
            "stress_xx": (("snapshot", "particle"), 2.0 * fields),
            "stress_yy": (("snapshot", "particle"), 0.0 * fields),
            "snapshot_label": ("snapshot", np.array(["t=0.3", "t=1.45", "vibrate"], dtype=object)),
            "snapshot_time": ("snapshot", [0.3, 1.45, 6.0]),
            "history_time": ("sample", time),
            "history_u_y": ("sample", np.sin(2 * np.pi * time / 6.0)),
        }
    )
    return run, config


def test_it_is_measured_with_the_tip_up_and_at_the_end():
    found = pressure.measure(*record())
    assert found["pressure_checkerboard"].value == pytest.approx(0.2 / np.hypot(1.0, 0.2), rel=2e-3)
    assert found["pressure_checkerboard_end"].value == pytest.approx(0.3 / np.hypot(1.0, 0.3), rel=2e-3)
    # To stripes, a checkerboard is one too.
    assert found["pressure_stripes_end"].value == pytest.approx(0.3 / np.hypot(1.0, 0.3), rel=2e-3)


def test_without_a_state_of_the_raised_tip_only_the_end_is_measured():
    run, config = record()
    found = pressure.measure(run.isel(snapshot=[2]), config)
    assert list(found) == ["pressure_checkerboard_end", "pressure_stripes_end"]
    assert pressure.measure(run.isel(snapshot=slice(0, 0)), config) == {}
