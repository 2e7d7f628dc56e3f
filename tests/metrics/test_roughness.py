"""Von Mises stress and its roughness on fields with known answers."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.catalogue import scene_module
from sphstudy.configuration.composition import session
from sphstudy.metrics import roughness
from sphstudy.metrics.von_mises import von_mises

ROWS = 5


def plate_record(field, labels=("t=1.6",), times=(1.6,), scene="plate"):
    """A plate whose σxx is field(columns, rows, x0, y0) and whose tip is highest at 2 s, at each time."""
    with session() as hydra:
        config = hydra.points([f"scene={scene}", f"n={ROWS}"], sweep=False)[0][0].config
    body = scene_module(scene).build(config).body
    column = np.tile(np.arange(body.x.size // ROWS), ROWS)
    values = [np.asarray(field(column, body.x, body.y) * scale) for scale in range(1, len(times) + 1)]
    time = np.linspace(0.0, 8.0, 401)
    data = {
        "stress_xx": (("snapshot", "particle"), np.array(values).reshape(len(times), body.x.size)),
        "snapshot_label": ("snapshot", np.array(labels, dtype=object)),
        "snapshot_time": ("snapshot", np.array(times)),
        "history_time": ("sample", time),
        "history_u_y": ("sample", np.sin(2 * np.pi * time / 8.0)),
        "reference_x": ("particle", body.x),
        "reference_y": ("particle", body.y),
        "spacing_x": body.spacing_x,
        "spacing_y": body.spacing_y,
    }
    data["stress_yy"] = data["stress_xy"] = (
        ("snapshot", "particle"),
        np.zeros_like(data["stress_xx"][1]),
    )
    return xr.Dataset(data), config


def measured(*arguments, **named):
    found = roughness.measure(*plate_record(*arguments, **named))
    return tuple(found[f"stress_roughness_{side}"].value for side in ("bottom", "top"))


def test_known_states():
    nu = 0.3
    # Uniaxial: the stress itself in plane stress, √(1 - ν + ν²) of it in plane strain; pure shear: √3 τ.
    assert von_mises(-2.0, 0.0, 0.0, "stress", nu) == pytest.approx(2.0)
    assert von_mises(2.0, 0.0, 0.0, "strain", nu) == pytest.approx(2.0 * np.sqrt(1 - nu + nu**2))
    for plane in ("stress", "strain"):
        assert von_mises(0.0, 0.0, 1.5, plane, nu) == pytest.approx(1.5 * np.sqrt(3.0))
    # Equal in all directions: nothing left where σzz is the same too.
    assert von_mises(1.0, 1.0, 0.0, "strain", 0.5) == pytest.approx(0.0, abs=1e-12)
    assert von_mises(np.ones((3, 2)), np.ones((3, 2)), np.zeros((3, 2)), "stress", nu).shape == (3, 2)


def test_a_field_that_is_linear_along_the_rows_is_smooth():
    assert measured(lambda k, x, y: (3.0 - x) * (2.0 + y)) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_a_zigzag_counts_twice_its_amplitude_where_it_is():
    """High and low by turns by 10 %: a particle differs from its neighbours' mean by 20 %."""
    field = lambda k, x, y: 1.0 + 0.1 * (-1.0) ** k * (y < 0)  # noqa: E731
    assert measured(field) == pytest.approx((0.2, 0.0), abs=1e-12)


def test_only_the_wall_region_beyond_the_reach_of_the_wall_counts():
    reach = 2.0 * 1.5 / (12 * ROWS)
    field = lambda k, x, y: 1.0 + 0.1 * (-1.0) ** k * ((x < 0.6 * reach) | (x > 0.3))  # noqa: E731
    assert measured(field) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_the_kept_time_closest_to_the_highest_tip_counts():
    """Roughness relative to its own field is the same at all times, unless only one of them is rough."""
    labels, times = ("t=1", "t=1.9", "t=6.5", "vibrate"), (1.0, 1.9, 6.5, 8.0)
    run, config = plate_record(lambda k, x, y: 1.0 + 0.0 * x, labels, times)
    zigzag = 0.1 * (-1.0) ** np.tile(np.arange(run.sizes["particle"] // ROWS), ROWS)
    for rough, expected in ((0, 0.0), (1, 0.1), (2, 0.0), (3, 0.0)):
        changed = run.copy(deep=True)
        changed["stress_xx"].values[rough] += zigzag
        found = roughness.measure(changed, config)["stress_roughness_bottom"].value
        assert found == pytest.approx(expected, abs=1e-12)


def test_a_bent_plate_is_measured_when_it_has_settled():
    run, config = plate_record(
        lambda k, x, y: 1.0 + 0.1 * (-1.0) ** k, ("load", "settle"), (1.0, 8.0), scene="bending"
    )
    run["stress_xx"].values[0] = 1.0
    assert roughness.measure(run, config)["stress_roughness_top"].value == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("labels", "times"), [(("vibrate",), (8.0,)), (("t=6", "vibrate"), (6.0, 8.0)), ((), ())]
)
def test_without_a_kept_time_with_the_tip_up_there_is_nothing_to_measure(labels, times):
    assert roughness.measure(*plate_record(lambda k, x, y: 1.0 + x, labels, times)) == {}


def test_without_stress_there_is_nothing_to_measure():
    assert roughness.measure(*plate_record(lambda k, x, y: 0.0 * x)) == {}
