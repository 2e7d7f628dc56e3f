"""Figures of stored data draw from whatever part of it is there, and show the numbers that are stored."""

import numpy as np
import pytest
from matplotlib.collections import PolyCollection

import sphstudy
from sphstudy.analysis import results
from sphstudy.analysis.results import Missing
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.metrics.von_mises import von_mises as von_mises_stress
from sphstudy.model.exact import beam, williams
from sphstudy.report import figure
from sphstudy.report.figures import (
    bending,
    choices,
    conjectures,
    crack,
    crack_field,
    plate,
    release_rates,
    von_mises,
)
from tests.support.figures import drawn, line
from tests.support.results import altered

STUDIES = ("plate", "bending", "bending_long", "mode1", "mode2", "choices", "conjectures")
MODULES = (plate, von_mises, bending, crack, crack_field, release_rates, choices, conjectures)
SETTINGS = {
    "plate": {"n": 5, "scene.periods": 0.3, "record.times": (1.5648, 1.5681)},
    "bending": {"n": 5, "scene.end_time": 1.0},
    "mode1": {"n": 16, "solve.load_steps": 400, "solve.settle_steps": 200, "solve.extend_steps": 100},
    "mode2": {"n": 16, "solve.load_steps": 400, "solve.settle_steps": 200, "solve.extend_steps": 100},
}


def listed():
    """Every figure drawn from data with the study that lists it."""
    for name in STUDIES:
        for label in study_file.load(name).figures:
            definition = figure.find(label)
            if any(definition in figure.defined(module) for module in MODULES):
                yield pytest.param(name, definition, id=f"{name}-{definition.number}")


LISTED = list(listed())


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    """A small record of each scene."""
    folder = tmp_path_factory.mktemp("records")
    return {
        scene: sphstudy.run(scene=scene, h=1.5, results=folder, **settings)
        for scene, settings in SETTINGS.items()
    }


@pytest.fixture(scope="module")
def empty(tmp_path_factory):
    """Results of each study from a store that holds nothing."""
    folder = str(tmp_path_factory.mktemp("empty"))
    with session() as hydra:
        return {name: results.load(name, hydra, [], folder) for name in STUDIES}


@pytest.fixture(scope="module")
def full(empty, records):
    """The same studies with made-up metrics, and the small record of its scene at every point."""
    random = np.random.default_rng(4)
    return {name: filled(found, records, random) for name, found in empty.items()}


def filled(found, records, random):
    table, attributes = found.table.assign(status="done"), {}
    for scene in found.table["scene"].unique():
        rows = found.table["scene"] == scene
        for name, variable in records[scene].data_vars.items():
            if variable.attrs.get("group") == "metric":
                attributes[name] = variable.attrs
                table.loc[rows, name] = random.uniform(0.01, 0.5, rows.sum())
    record = lambda row: records[table.at[row, "scene"]]  # noqa: E731
    return altered(found, table=table, attributes=attributes, record=record)


def without(found, column, rows):
    """The same results with a metric gone in some rows (a mask)."""
    result = altered(found)
    result.table.loc[rows, column] = np.nan
    return result


@pytest.mark.parametrize(("name", "definition"), LISTED)
def test_every_figure_draws(name, definition, full, monkeypatch):
    # The small record ends long before the thesis looks again.
    monkeypatch.setattr(bending, "LONG", 0.5)
    drawing = drawn(definition, full[name])
    assert any(axes.has_data() for axes in drawing.axes)


@pytest.mark.parametrize(
    ("name", "definition"),
    # Curvatures follow from the settings alone.
    [case for case in LISTED if case.values[1] is not conjectures.kernel_curvature],
)
def test_an_empty_store_is_said_to_lack_data(name, definition, empty):
    with pytest.raises(Missing, match=name):
        drawn(definition, empty[name])


def test_every_figure_is_listed():
    there = {definition for module in MODULES for definition in figure.defined(module)}
    assert there == {case.values[1] for case in LISTED}
    numbers = [case.values[1].number for case in LISTED]
    assert len(set(numbers)) == len(numbers)


@pytest.mark.parametrize(
    ("definition", "name", "metric", "symbol"),
    [
        ("plate.frequency_error", "plate", "frequency_error", "n_y"),
        ("plate.amplitude_error", "plate", "amplitude_error", "n_y"),
        ("plate.frequency_error_2d", "plate", "frequency_error_2d", "n_y"),
        ("release_rates.mode1_propagation", "mode1", "G1_error", "n_x"),
        ("release_rates.mode2_projection", "mode2", "G2_error", "n_x"),
    ],
)
def test_curves_carry_the_table_and_leave_gaps(definition, name, metric, symbol, full):
    table = full[name].table
    gap = (table["block"] == "grid") & (table["h"] == 1.5) & (table["n"] == table["n"].min())
    partial = without(full[name], metric, gap)
    (axes,) = drawn(definition, partial).axes
    grid = partial.grid(metric)
    assert grid.isna().to_numpy().sum() == 1
    for n, column in grid.items():
        h, shown = line(axes, f"${symbol} = {n}$")
        np.testing.assert_array_equal(h, column.index)
        np.testing.assert_allclose(shown, 100.0 * column)


def test_unstable_cells_are_ringed_and_no_others(full):
    (axes,) = drawn("plate.frequency_error", full["plate"]).axes
    h, shown = line(axes, "unstable cell")
    np.testing.assert_array_equal(h, [1.3, 1.3])
    grid = full["plate"].grid("frequency_error")
    np.testing.assert_allclose(shown, 100.0 * grid.loc[1.3, [15, 21]])


def test_the_axis_shows_zero_where_that_is_cheap(full):
    near, far = altered(full["mode1"]), altered(full["mode1"])
    spread = np.linspace(0.0, 0.1, len(near.table))
    near.table, far.table = (near.table.assign(G2_error=low + spread) for low in (0.05, 0.2))
    limits = [
        drawn("release_rates.mode1_projection", found).axes[0].get_ylim()[0] for found in (near, far)
    ]
    assert limits[0] <= 0.0 < limits[1]


def test_norms_are_divided_by_their_maximum_on_the_grid(full):
    drawing = drawn("release_rates.mode2_stress_norms", full["mode2"])
    for axes, component in zip(drawing.axes, ("xx", "yy", "xy"), strict=True):
        grid = full["mode2"].grid(f"stress_{component}_rms")
        curves = [line(axes, f"$n_x = {n}$")[1] for n in grid]
        np.testing.assert_allclose(curves, (grid / grid.to_numpy().max()).T)
        assert np.max(curves) == 1.0


def test_the_tip_is_drawn_with_fit_and_beam(full, records):
    (axes,) = drawn(plate.tip_displacement, full["plate"]).axes
    run, cell = records["plate"], {"h": 1.5, "n": 21}
    time, u_y = line(axes, "SPH")
    assert set(zip(time, u_y, strict=True)) <= set(
        zip(run["history_time"].values, run["history_u_y"].values / 1e-3, strict=True)
    )
    names = ("amplitude", "decay_rate", "frequency")
    a, kappa, omega = (full["plate"].value(name, cell, "grid") for name in names)
    time, fit = line(axes, "fit (3.3)")
    np.testing.assert_allclose(fit, 1e3 * a * np.exp(-kappa * time) * np.sin(omega * time))
    time, exact = line(axes, "beam (3.1)")
    omega0 = beam.fundamental_frequency(1e6, 7750.0, 1.0, 1.0 / 12.0)
    tip = beam.mode_shape(run["reference_x"].values.max(), 1.0)
    np.testing.assert_allclose(exact, 20.0 * tip * np.sin(omega0 * time))


def test_stress_fields_are_those_of_the_snapshot_asked_for(full, records):
    run = records["plate"]
    for definition, time in (("von_mises.fine_medium", 1.5681), ("von_mises.coarse_narrow", 1.5648)):
        state = von_mises.snapshot_at(run, time)
        assert abs(float(state["snapshot_time"]) - time) <= float(run["time_step"])
        xx, yy, xy = (state[f"stress_{c}"].values for c in ("xx", "yy", "xy"))
        expected = von_mises_stress(xx, yy, xy, "strain", 0.3) / 1e3
        for axes in drawn(definition, full["plate"]).axes[:2]:
            (field,) = (c for c in axes.collections if isinstance(c, PolyCollection))
            np.testing.assert_allclose(field.get_array(), expected)


def test_a_snapshot_more_than_a_step_away_is_missing(records):
    run = records["plate"]
    with pytest.raises(Missing, match="t = 1 s"):
        von_mises.snapshot_at(run, 1.0)


def test_the_centreline_is_drawn_in_whole_and_in_parts(full, records):
    run = records["bending"]
    centre = run["tag_centreline"].values == 1
    u_y = (run["y"][-1].values - run["reference_y"].values)[centre] / 1e-3
    x0 = run["reference_x"].values[centre]
    whole, difference = drawn(bending.centreline, full["bending"]).axes
    exact = beam.bent_centreline(x0, -0.04, 1.0, float(run["spacing_x"])) / 1e-3
    np.testing.assert_allclose(line(whole, "beam"), [x0, exact])
    np.testing.assert_allclose(difference.get_lines()[0].get_ydata(), u_y - exact, atol=1e-12)
    for definition, part in (
        ("bending.centreline_wall", x0 <= 0.15),
        ("bending.centreline_end", x0 >= 0.9),
    ):
        (axes,) = drawn(definition, full["bending"]).axes
        np.testing.assert_allclose(line(axes, "SPH"), [x0[part], u_y[part]])


def test_positions_long_after_wait_for_their_time(full, monkeypatch):
    with pytest.raises(Missing, match="150 s"):
        drawn(bending.positions_long_after, full["bending_long"])
    monkeypatch.setattr(bending, "LONG", 0.5)
    drawing = drawn(bending.positions_long_after, full["bending_long"])
    assert drawing.axes[0].get_title() == "$n_y = 5$, $\\tilde{h} = 1.5$, $t = 1$ s"


@pytest.mark.parametrize(
    ("definition", "mode", "tag", "component"),
    [
        ("crack.mode1_faces", 1, "faces", "y"),
        ("crack.mode2_faces", 2, "faces", "x"),
        ("crack.mode1_stress_xy", 1, "ahead", "xy"),
        ("crack.mode2_stress_yy", 2, "ahead", "yy"),
        ("crack.mode2_stress_xy", 2, "ahead", "xy"),
    ],
)
def test_rows_beside_the_crack_and_the_exact_curves(definition, mode, tag, component, full, records):
    run = records[f"mode{mode}"]
    state = run.isel(snapshot=1)
    half = 0.5 * float(run["spacing_y"])
    (axes,) = drawn(definition, full[f"mode{mode}"]).axes
    for side, row in ((1.0, "above"), (-1.0, "below")):
        chosen = (run[f"tag_{tag}"].values == 1) & (side * run["reference_y"].values > 0.0)
        free = chosen & (run["tag_frame"].values == 0)
        x, shown = line(axes, f"SPH, row {row}")
        np.testing.assert_array_equal(x, run["reference_x"].values[free])
        if tag == "faces":
            values = state[component].values - run[f"reference_{component}"].values
            np.testing.assert_allclose(shown, values[free] / 1e-3)
        else:
            np.testing.assert_allclose(shown, state[f"stress_{component}"].values[free] / 1e6)
        both = any(one.get_label() == "exact, both rows" for one in axes.get_lines())
        assert both == ((mode, component) == (2, "xy"))
        x, shown = line(axes, "exact, both rows" if both else f"exact, row {row}")
        y = np.full_like(x, side * half)
        if tag == "faces":
            exact = williams.displacement(mode, x, y, 35.8e3, 6e6, 0.3)["xy".index(component)] / 1e-3
        else:
            index = ("xx", "yy", "xy").index(component)
            exact = williams.stress(mode, x, y, 35.8e3)[index] / 1e6
        np.testing.assert_allclose(shown, exact)


def test_the_deformed_square_stands_at_its_positions(full, records):
    state = records["mode1"].isel(snapshot=1)
    drawing = drawn("crack_field.mode1_field", full["mode1"])
    (field,) = (c for c in drawing.axes[0].collections if isinstance(c, PolyCollection))
    centres = np.array([path.vertices[:4].mean(axis=0) for path in field.get_paths()])
    np.testing.assert_allclose(centres, np.column_stack((state["x"].values, state["y"].values)))
    np.testing.assert_allclose(field.get_array(), state["stress_yy"].values / 1e3)
    limit = williams.stress(1, np.array(0.01), np.array(0.0), 35.8e3)[1] / 1e3
    np.testing.assert_allclose(field.get_clim(), [0.0, limit])


def test_effects_have_size_sign_and_what_is_missing(full):
    found = altered(full["choices"])
    rows = found.table["block"] == "mode1"
    changes = {
        "": 0.0,
        "scene.rho=7750.0000001": 1e-4,
        "scene.frame_layers=1": -0.02,
        "scene.frame_layers=4": 0.0,
        "method.retest_visibility=False": 1e-12,
    }
    for varied, change in changes.items():
        found.table.loc[rows & (found.table["varied"] == varied), "G1_error"] = -0.1 + change
    gone = rows & (found.table["varied"] == "method.visibility=exclusive")
    found.table.loc[gone, ["G1_error", "status"]] = [np.nan, "diverged"]

    axes = drawn("choices.mode1", found).axes[0]
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert labels[-1] == "control"
    marks = {labels[round(one.get_ydata()[0])]: one for one in axes.get_lines()}
    assert axes.get_title() == "$G_1$ error\nbase: \N{MINUS SIGN}10 %"
    layer, control = marks["frame_layers = 1"], marks["control"]
    np.testing.assert_allclose([layer.get_xdata()[0], control.get_xdata()[0]], [2.0, 1e-2], rtol=1e-6)
    assert (layer.get_marker(), control.get_marker()) == ("v", "o")
    assert marks["settle_steps = 8000"].get_marker() == "^"
    texts = {labels[round(t.xy[1])]: t.get_text() for t in axes.texts}
    assert texts["frame_layers = 1"] == "\N{MINUS SIGN}2"
    assert texts["frame_layers = 4"] == "0"
    assert texts["retest_visibility = False"] == "+1e\N{MINUS SIGN}10"
    assert not {"frame_layers = 4", "retest_visibility = False"} & set(marks)
    assert texts["visibility = exclusive"] == "diverged"
    # The grey reaches from the edge to the effect of the control.
    (band,) = axes.patches
    assert band.get_x() + band.get_width() == pytest.approx(1e-2)


def test_curvatures_are_the_kernels_own_at_the_nearest_neighbours(empty):
    (axes,) = drawn(conjectures.kernel_curvature, empty["conjectures"]).axes
    marks = [one.get_xydata().T for one in axes.get_lines() if one.get_marker() != "None"]
    assert len(marks) == 3
    scale = 15.0 / (7.0 * np.pi)
    q, cubic = marks[0]
    np.testing.assert_allclose(q, 1.0 / np.array([1.3, 1.5, 1.7]))
    np.testing.assert_allclose(cubic, scale * (3.0 * q - 2.0), atol=1e-14)


def test_spikes_and_clumps_stand_at_their_kernel_and_h(full):
    table = full["conjectures"].table
    cell = (table["block"] == "plate") & (table["method.kernel"] == "wendland") & (table["h"] == 1.7)
    light = cell & (table["scene.H0"] == 2e-5) & (table["method.artificial_stress"] == 0.3)
    axes = drawn(conjectures.spikes, full["conjectures"]).axes[3]
    assert axes.get_title() == "above the axis, load × 0.001"
    place = [tick.get_text() for tick in axes.get_xticklabels(minor=True)].index("wendland") * 2 + 1
    expected = 100.0 * table.loc[light, "stress_roughness_top"].item()
    assert line(axes, "$\\zeta = 0.3$")[1][place] == pytest.approx(expected)

    below = drawn(conjectures.clumping, full["conjectures"]).axes[0]
    bent = table[table["block"] == "bending_load"]["spacing_spread_bottom"].item()
    shown = line(below, "load × 0.001")[1]
    # The cubic kernel comes first.
    place = [tick.get_text() for tick in below.get_xticklabels()].index("1.7")
    np.testing.assert_allclose(shown[place], 100.0 * bent)
    assert np.isnan(np.delete(shown, place)).all()


def test_antisymmetry_is_drawn_for_each_load_and_artificial_stress(full):
    found = full["conjectures"]
    for axes, component in zip(drawn(conjectures.antisymmetry, found).axes, ("xx", "yy"), strict=True):
        for load, name in ((35.8e3, "load × 1"), (35.8, "load × 0.001")):
            settings = {"scene.K": load, "method.artificial_stress": 0.0}
            rows = found.select(settings, block="mode2")
            h, shown = line(axes, f"{name}, without artificial stress")
            np.testing.assert_array_equal(h, rows["h"])
            np.testing.assert_allclose(shown, 100.0 * rows[f"stress_{component}_parity_defect_ahead"])
