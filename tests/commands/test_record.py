"""What the record of a crack run holds: stages, fields, metrics, cost, provenance."""

import json

import numpy as np
import pytest

import sphstudy
from sphstudy.store.record import configuration

SHORT = {"solve.load_steps": 600, "solve.settle_steps": 400, "solve.extend_steps": 300}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("record")
    return sphstudy.run(scene="mode1", n=16, results=folder, **SHORT)


def test_states_are_kept_at_the_end_of_every_stage(run):
    assert [str(v) for v in run["snapshot_label"].values] == ["load", "settle", "extend1", "extend2"]
    np.testing.assert_array_equal(run["snapshot_step"], [600, 1000, 1300, 1600])


def test_the_frame_has_reached_its_target_and_stays(run):
    from sphstudy.model.exact import williams

    frame = run["tag_frame"].values == 1
    x0, y0 = run["reference_x"].values[frame], run["reference_y"].values[frame]
    u_x, u_y = williams.displacement(1, x0, y0, 35.8e3, 6e6, 0.3)
    for stage in range(4):
        np.testing.assert_allclose(run["x"][stage].values[frame] - x0, u_x, atol=1e-15)
        np.testing.assert_allclose(run["y"][stage].values[frame] - y0, u_y, atol=1e-15)


def test_opening_the_crack_releases_energy(run):
    energies = [float(run[f"U{k}"]) for k in range(3)]
    assert energies[0] > energies[1] > energies[2]


def test_mode_i_stays_symmetric(run):
    """Mirror images of each other: rounding apart, whatever the crack and the order of the sums."""
    n = 16
    y = run["y"].isel(snapshot=1).values.reshape(n, n)
    x = run["x"].isel(snapshot=1).values.reshape(n, n)
    np.testing.assert_allclose(y, -y[::-1], atol=1e-12)
    np.testing.assert_allclose(x, x[::-1], atol=1e-12)


def test_energy_balance_is_measured(run):
    history = {name: run[f"history_{name}"].values for name in ("strain_energy", "kinetic_energy")}
    assert float(run["external_work"]) > 0.9 * history["strain_energy"][-1]
    assert 0.0 < float(run["dissipated_energy"]) < 1.0
    assert float(run["net_internal_force"]) < 1e-12


def test_constraints_put_in_power_while_they_move_and_only_then(run):
    """Two samples where loading ends: with the motion that ends, and without."""
    step, power = run["history_step"].values, run["history_constraint_power"].values
    assert np.count_nonzero(step == 600) == 2
    assert (power[1 : np.argmax(step == 600) + 1] > 0.0).all()
    assert (power[np.argmax(step == 600) + 1 :] == 0.0).all()


def test_every_variable_has_a_name_and_a_unit(run):
    for name, variable in run.data_vars.items():
        assert variable.attrs.get("long_name"), name
        assert variable.attrs.get("units"), name


def test_the_record_says_where_it_comes_from(run):
    for attribute in (
        "Conventions", "configuration", "key", "numerics_version", "metrics_version", "git_state",
        "processor", "threads", "library_versions", "python_version", "date_created",
    ):  # fmt: skip
        assert run.attrs[attribute], attribute
    assert json.loads(run.attrs["configuration"])["seed"] == 0
    config = configuration(run)
    assert (config.n, config.solve.load_steps) == (16, 600)
    for cost in (
        "cpu_seconds",
        "wall_seconds",
        "compile_seconds",
        "steps",
        "particles",
        "pairs",
        "peak_memory",
    ):
        assert run[cost].attrs["group"] == "cost"
        assert float(run[cost]) >= 0.0
    assert float(run["steps"]) == 1600
    assert float(run["particles"]) == 256
