"""Distances to the nearest neighbour on lattices with known answers."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.catalogue import scene_module
from sphstudy.configuration.composition import session
from sphstudy.metrics import regularity


def plate_record(labels=("load", "settle"), times=(0.2, 11.0), scene="bending"):
    """An undeformed plate at each time."""
    with session() as hydra:
        config = hydra.points([f"scene={scene}", "n=5"], sweep=False)[0][0].config
    body = scene_module(scene).build(config).body
    shape = (len(times), 1)
    data = {
        "x": (("snapshot", "particle"), np.tile(body.x, shape)),
        "y": (("snapshot", "particle"), np.tile(body.y, shape)),
        "snapshot_label": ("snapshot", np.array(labels, dtype=object)),
        "snapshot_time": ("snapshot", np.array(times)),
        "reference_x": ("particle", body.x),
        "reference_y": ("particle", body.y),
        "spacing_x": body.spacing_x,
        "spacing_y": body.spacing_y,
    }
    return xr.Dataset(data), config


def values(run, config):
    return {name: metric.value for name, metric in regularity.measure(run, config).items()}


def test_a_lattice_is_regular():
    found = values(*plate_record())
    assert len(found) == 6
    for part in ("bottom", "top", "rest"):
        assert found[f"spacing_smallest_{part}"] == pytest.approx(1.0)
        assert found[f"spacing_spread_{part}"] == pytest.approx(0.0, abs=1e-12)


def test_particles_in_pairs_are_closer_but_all_alike():
    """Every second column moved by 0.3 Δ towards the next: closer everywhere, the spread stays zero."""
    run, config = plate_record()
    column = np.tile(np.arange(60), 5)
    run["x"].values[-1] += np.where(column % 2 == 0, 0.3, 0.0) * float(run["spacing_x"])
    found = values(run, config)
    ratio = float(run["spacing_x"] / run["spacing_y"])
    assert found["spacing_smallest_rest"] == pytest.approx(0.7 * ratio)
    assert found["spacing_spread_rest"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("x", "y", "part"), [(0.15, -1, "bottom"), (0.15, 1, "top"), (0.6, -1, "rest")])
def test_one_particle_out_of_place_shows_where_it_is(x, y, part):
    run, config = plate_record()
    rows = run["reference_y"].values
    near = np.hypot(run["reference_x"].values - x, rows - y * rows.max())
    run["y"].values[-1, int(np.argmin(near))] += -0.4 * y * float(run["spacing_y"])
    found = values(run, config)
    for other in ("bottom", "top", "rest"):
        assert found[f"spacing_smallest_{other}"] == pytest.approx(0.6 if other == part else 1.0)
        assert (found[f"spacing_spread_{other}"] > 0.01) == (other == part)


def test_spread_is_standard_deviation_over_mean():
    """Half of the particles below the axis have neighbours at 0.8 Δ, the others at Δ."""
    run, config = plate_record()
    distance = regularity.nearest_distances(np.array([0.0, 1.0, 2.0, 2.8]), np.zeros(4))
    np.testing.assert_allclose(distance, [1.0, 1.0, 0.8, 0.8])
    assert distance.std() / distance.mean() == pytest.approx(0.1 / 0.9)
    rows, spacing = run["reference_y"].values, float(run["spacing_y"])
    lowest = rows == rows.min()
    # The lowest row up by 0.2 Δ: it and the row above it, all there is below the axis, are at 0.8 Δ.
    run["y"].values[-1] += np.where(lowest, 0.2 * spacing, 0.0)
    found = values(run, config)
    assert found["spacing_spread_bottom"] == pytest.approx(0.0, abs=1e-12)
    assert found["spacing_smallest_bottom"] == pytest.approx(0.8)
    # All in the rest at Δ but for its two lowest rows of five.
    shares = np.array([0.8] * 2 + [1.0] * 3)
    assert found["spacing_spread_rest"] == pytest.approx(shares.std() / shares.mean(), rel=1e-6)


def test_the_state_at_11_s_is_measured_beside_the_last():
    run, config = plate_record(("load", "t=11.0001", "t=50", "settle"), (0.2, 11.0001, 50.0, 160.0))
    lowest = run["reference_y"].values == float(run["reference_y"].min())
    run["y"].values[1] += np.where(lowest, 0.2 * float(run["spacing_y"]), 0.0)
    found = values(run, config)
    assert found["spacing_smallest_bottom_11s"] == pytest.approx(0.8)
    assert found["spacing_smallest_bottom"] == pytest.approx(1.0)


def test_a_record_without_that_time_or_without_any_state_is_measured_as_far_as_it_goes():
    found = values(*plate_record(("t=1.5", "vibrate"), (1.5, 6.5), scene="plate"))
    assert not any(name.endswith("_11s") for name in found)
    run, config = plate_record()
    assert regularity.measure(run.isel(snapshot=slice(0, 0)), config) == {}
