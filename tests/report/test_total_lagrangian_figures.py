"""Figures of the total Lagrangian method, alone and beside the thesis's, show what is stored."""

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex

import sphstudy
from sphstudy.analysis import results
from sphstudy.analysis.results import Missing
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.metrics.regularity import nearest_distances
from sphstudy.metrics.von_mises import von_mises
from sphstudy.model.exact import williams
from sphstudy.report import figure
from sphstudy.report.figures import (
    bending,
    side_by_side,
    side_by_side_fields,
    total_lagrangian,
)
from tests.support.figures import drawn, line
from tests.support.results import altered

MODULES = (side_by_side, side_by_side_fields, total_lagrangian)
STUDIES = ("thesis_vs_tl", "tl_plate", "tl_bending", "tl_mode1", "tl_mode2")
LISTED = [
    pytest.param(name, figure.find(label), id=label)
    for name in STUDIES
    for label in study_file.load(name).figures
]
FEW_STEPS = {"solve.load_steps": 400, "solve.settle_steps": 200, "solve.extend_steps": 100}
SETTINGS = {
    ("plate", "thesis"): {"n": 5, "scene.periods": 0.3, "record.times": (1.5681,)},
    ("plate", "tl"): {"n": 5, "scene.periods": 0.3, "record.times": (1.5681,)},
    ("bending", "thesis"): {"n": 5, "scene.end_time": 1.0, "record.times": (0.25, 0.5)},
    ("bending", "tl"): {"n": 5, "scene.end_time": 1.0, "record.times": (0.25, 0.5)},
    ("mode1", "thesis"): {"n": 16, **FEW_STEPS},
    ("mode1", "tl"): {"n": 16, "solve": "equilibrium"},
    ("mode2", "thesis"): {"n": 16, **FEW_STEPS},
    ("mode2", "tl"): {"n": 16, "solve": "equilibrium"},
}
EARLY, LONG = 0.25, 0.5
"""Times (s) that the small records of the bent plate have, in place of 11 s and 150 s."""

METRICS = (
    *("frequency_error_2d", "bending_energy_error", "end_angle_error_2d", "G1_error", "G2_error"),
    *("J_error", "K_I_integral_error", "K_II_integral_error", "cpu_seconds"),
)


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    """A small record of each scene by each method."""
    folder = tmp_path_factory.mktemp("records")
    return {
        (scene, method): sphstudy.run(scene=scene, method=method, h=1.5, results=folder, **settings)
        for (scene, method), settings in SETTINGS.items()
    }


@pytest.fixture(scope="module")
def empty(tmp_path_factory):
    """Results of each study, and of those that it looks into, from a store that holds nothing."""
    folder = str(tmp_path_factory.mktemp("empty"))
    with session() as hydra:
        names = (*STUDIES, "bending_long", "plate")
        return {name: results.load(name, hydra, [], folder) for name in names}


@pytest.fixture(scope="module")
def full(empty, records):
    """The same studies with made-up metrics, and the small record of scene and method at every point."""
    random, found = np.random.default_rng(4), {}
    for name, without in empty.items():
        rows = len(without.table)
        made_up = {metric: random.uniform(0.01, 0.03, rows) for metric in METRICS}
        spacing = 0.2 / without.table["n"]
        table = without.table.assign(status="done", spacing=spacing, **made_up)
        found[name] = altered(
            without,
            table=table,
            record=lambda row, table=table: records[table.at[row, "scene"], table.at[row, "method"]],
            other=lambda other, overrides: found[other],
        )
    return found


@pytest.fixture(autouse=True)
def early(monkeypatch):
    monkeypatch.setattr(total_lagrangian, "EARLY", EARLY)
    monkeypatch.setattr(bending, "LONG", LONG)


def changed(found, rows, **values):
    """The same results with other values in some rows (a mask)."""
    result = altered(found)
    for column, value in values.items():
        result.table.loc[rows, column] = value
    return result


def centres(axes):
    """Middles [M, 2] of the rectangles in these axes, and their values."""
    (field,) = (one for one in axes.collections if isinstance(one, PolyCollection))
    return np.array([path.vertices[:4].mean(axis=0) for path in field.get_paths()]), field


@pytest.mark.parametrize(("name", "definition"), LISTED)
def test_every_figure_draws(name, definition, full):
    assert any(axes.has_data() for axes in drawn(definition, full[name]).axes)


@pytest.mark.parametrize(("name", "definition"), LISTED)
def test_an_empty_store_is_said_to_lack_data(name, definition, empty):
    with pytest.raises(Missing):
        drawn(definition, empty[name])


def test_every_figure_is_listed_once():
    there = {definition for module in MODULES for definition in figure.defined(module)}
    listed = [case.values[1] for case in LISTED]
    assert there == set(listed)
    assert len({definition.number for definition in listed}) == len(listed)


def test_each_method_has_its_panel_and_its_own_numbers(full):
    found = full["thesis_vs_tl"]
    cases = [(side_by_side.plate_frequency, "plate", ["frequency_error_2d"], "n_y")]
    cases += [
        (rates, f"mode{mode}", ["G1_error", "G2_error", f"K_{'I' * mode}_integral_error"], "n_x")
        for mode, rates in (
            (1, "side_by_side.mode1_release_rates"),
            (2, "side_by_side.mode2_release_rates"),
        )
    ]
    for definition, scene, metrics, symbol in cases:
        panels = np.reshape(drawn(definition, found).axes, (-1, 2))
        assert [axes.get_title() for axes in panels[0]] == ["thesis", "total Lagrangian"]
        for pair, metric in zip(panels, metrics, strict=True):
            for axes, method in zip(pair, ("thesis", "tl"), strict=True):
                rows = found.select({"scene": scene, "method": method})
                for n, cells in rows.groupby("n"):
                    h, shown = line(axes, f"${symbol} = {n}$")
                    np.testing.assert_array_equal(h, cells["h"])
                    np.testing.assert_allclose(shown, 100.0 * cells[metric])


def test_panels_share_a_scale_unless_errors_differ_by_much(full):
    found = full["thesis_vs_tl"]
    thesis = (found.table["block"] == "plate") & (found.table["method"] == "thesis")
    for factor, said in ((-1.0, ""), (-100.0, "own scale")):
        errors = factor * found.table.loc[thesis, "frequency_error_2d"]
        panels = drawn(
            side_by_side.plate_frequency, changed(found, thesis, frequency_error_2d=errors)
        ).axes
        same = panels[0].get_ylim() == panels[1].get_ylim()
        assert same == (not said)
        for axes in panels:
            assert axes.get_title("right") == said
            # How far from zero errors are can be seen on either scale.
            low, high = axes.get_ylim()
            assert low <= 0.0 <= high


def test_unstable_cells_of_the_thesis_are_ringed(full):
    found = full["thesis_vs_tl"]
    thesis, other = drawn(side_by_side.plate_frequency, found).axes
    grid = found.grid("frequency_error_2d", {"method": "thesis"}, "plate")
    h, shown = line(thesis, "unstable cell")
    np.testing.assert_array_equal(h, [1.3, 1.3])
    np.testing.assert_allclose(shown, 100.0 * grid.loc[1.3, [15, 21]])
    assert "unstable cell" not in [one.get_label() for one in other.get_lines()]


def test_errors_of_one_method_alone_are_said_to_lack_the_other(full):
    found = full["thesis_vs_tl"]
    gone = found.table["method"] == "tl"
    with pytest.raises(Missing, match="method tl"):
        drawn(side_by_side.plate_frequency, changed(found, gone, frequency_error_2d=np.nan))


def test_cost_is_drawn_for_each_way_of_solving(full):
    found = full["thesis_vs_tl"]
    for axes, (scene, (metric, _, _)) in zip(
        drawn(side_by_side.error_and_cost, found).axes, side_by_side._COSTS.items(), strict=True
    ):
        extra = full[f"tl_{scene}"].select(block="modes" if scene == "plate" else "stepped")
        expected = {
            (cpu, 100.0 * error)
            for rows in (found.select({"scene": scene}), extra)
            for cpu, error in zip(rows["cpu_seconds"], rows[metric].abs(), strict=True)
        }
        points = {tuple(point) for one in axes.get_lines() for point in one.get_xydata()}
        np.testing.assert_allclose(sorted(points), sorted(expected))
        sizes = [one.get_markersize() for one in axes.get_lines()]
        assert len(set(sizes)) == (4 if scene == "plate" else 3)


def test_errors_below_zero_are_hollow_in_the_cost(full):
    found = full["thesis_vs_tl"]
    thesis = (found.table["block"] == "plate") & (found.table["method"] == "thesis")
    axes = drawn(side_by_side.error_and_cost, changed(found, thesis, frequency_error_2d=-0.04)).axes[0]
    for one in axes.get_lines():
        hollow = one.get_markerfacecolor() == "none"
        assert hollow == np.allclose(one.get_ydata(), 4.0) == (one.get_color() == "C0")


def test_runs_without_an_error_have_no_place_in_the_cost(full):
    lacking = {
        name: changed(found, found.table["scene"] == "mode1", K_I_integral_error=np.nan)
        for name, found in full.items()
    }
    found = lacking["thesis_vs_tl"]
    found = altered(found, other=lambda name, overrides: lacking[name])
    with pytest.raises(Missing, match="no point of scene mode1 has K_I_integral_error"):
        drawn(side_by_side.error_and_cost, found)


def test_stresses_of_the_plate_have_the_same_colours(full, records):
    drawing = drawn(side_by_side_fields.plate_stress, full["thesis_vs_tl"])
    limits = []
    for axes, method in zip(drawing.axes, ("thesis", "tl"), strict=False):
        run = records["plate", method]
        state = side_by_side_fields.snapshot_at(run, 1.5681)
        near = run["reference_x"].values < 0.2
        xx, yy, xy = (state[f"stress_{c}"].values[near] for c in ("xx", "yy", "xy"))
        _, field = centres(axes)
        expected = von_mises(xx, yy, xy, "strain", 0.3) / 1e3
        np.testing.assert_allclose(field.get_array(), expected)
        limits.append(field.get_clim())
        assert limits[0][1] >= expected.max()
    assert limits[0] == limits[1]


@pytest.mark.parametrize(
    ("definition", "name", "panels"),
    [
        (
            side_by_side_fields.bending_positions,
            "thesis_vs_tl",
            {("thesis", LONG): "thesis, $n_y = 5$", ("tl", LONG): "total Lagrangian, $n_y = 5$"},
        ),
        (
            total_lagrangian.bending_held,
            "tl_bending",
            {("tl", EARLY): "$t = 0.25$ s", ("tl", LONG): "$t = 0.5$ s"},
        ),
    ],
)
def test_particles_beside_the_wall_stand_where_they_are(definition, name, panels, full, records):
    drawing = drawn(definition, full[name])
    for axes, ((method, time), title) in zip(drawing.axes, panels.items(), strict=True):
        state = side_by_side_fields.snapshot_at(records["bending", method], time)
        x, y = state["x"].values, state["y"].values
        near = x < 0.3
        np.testing.assert_allclose(centres(axes)[0], np.column_stack((x, y))[near], atol=1e-12)
        closest = nearest_distances(x, y)[near].min() / float(state["spacing_x"])
        assert axes.get_title() == f"{title}\nclosest pair: {closest:.3f} $\\Delta x$"


def test_positions_wait_for_both_runs_and_for_their_time(full, empty, monkeypatch):
    found = altered(
        full["thesis_vs_tl"],
        other=lambda name, overrides: (empty if name == "bending_long" else full)[name],
    )
    with pytest.raises(Missing, match=r"bending_long: bending h=1\.7 n=9 is missing"):
        drawn(side_by_side_fields.bending_positions, found)
    monkeypatch.setattr(bending, "LONG", 150.0)
    with pytest.raises(Missing, match="t = 150 s"):
        drawn(total_lagrangian.bending_held, full["tl_bending"])


@pytest.mark.parametrize("mode", [1, 2])
def test_rows_ahead_of_the_tip_and_the_exact_curves(mode, full, records):
    definition = f"side_by_side_fields.mode{mode}_stress"
    panels = np.reshape(drawn(definition, full["thesis_vs_tl"]).axes, (3, 2))
    for column, method in zip(panels.T, ("thesis", "tl"), strict=True):
        run = records[f"mode{mode}", method]
        state = run.isel(snapshot=1)
        for axes, component in zip(column, ("xx", "yy", "xy"), strict=True):
            for side, row in ((1.0, "above"), (-1.0, "below")):
                there = (run["tag_ahead"].values == 1) & (side * run["reference_y"].values > 0.0)
                free = there & (run["tag_frame"].values == 0)
                x, shown = line(axes, f"SPH, row {row}")
                np.testing.assert_array_equal(x, run["reference_x"].values[free])
                np.testing.assert_allclose(shown, state[f"stress_{component}"].values[free] / 1e3)
                x, shown = line(axes, f"exact, row {row}")
                y = np.full_like(x, 0.5 * side * float(run["spacing_y"]))
                exact = williams.stress(mode, x, y, 35.8e3)[("xx", "yy", "xy").index(component)]
                np.testing.assert_allclose(shown, exact / 1e3)


def test_frequencies_are_those_of_the_grid_and_of_the_finest_modes(full):
    found = full["tl_plate"]
    (axes,) = drawn(total_lagrangian.plate_frequency, found).axes
    for n, block, label in (
        (9, "grid", "$n_y = 9$"),
        (21, "grid", "$n_y = 21$"),
        (41, "modes", "$n_y = 41$, modes"),
    ):
        cells = found.select({"n": n}, block)
        np.testing.assert_allclose(line(axes, label), [cells["h"], 100.0 * cells["frequency_error_2d"]])


def test_a_refinement_shows_signs_and_draws_no_line_across_a_change(full):
    found = full["tl_plate"]
    sign = found.table["n"].map({9: -1.0, 15: -1.0, 21: -1.0, 41: 1.0})
    size = 10.0 / found.table["n"] ** 2
    modes = found.table["block"] == "modes"
    (axes,) = drawn(
        total_lagrangian.plate_refinement, changed(found, modes, frequency_error_2d=sign * size)
    ).axes
    spacing, percent = 1e3 / 12.0 / np.array([9, 15, 21, 41]), 1e3 / np.array([9, 15, 21, 41]) ** 2
    marks = [one for one in axes.get_lines() if one.get_linestyle() == "None" and one.get_color() == "C0"]
    shown = {to_hex(one.get_markerfacecolor()): one.get_xydata().T for one in marks}
    np.testing.assert_allclose(shown["#ffffff"], [spacing[:3], percent[:3]])
    np.testing.assert_allclose(shown[to_hex("C0")], [spacing[3:], percent[3:]])
    lines = [one.get_xdata() for one in axes.get_lines() if one.get_linestyle() == "-"]
    joined = {tuple(np.round(x, 9)) for x in lines if len(x)}
    assert joined == {tuple(np.round(spacing[k : k + 2], 9)) for k in (0, 1)}


def test_guides_have_first_and_second_order(full):
    (axes,) = drawn(total_lagrangian.plate_refinement, full["tl_plate"]).axes
    dotted = [one.get_xydata() for one in axes.get_lines() if one.get_linestyle() == ":"]
    slopes = [np.diff(np.log(y))[0] / np.diff(np.log(x))[0] for x, y in (one.T for one in dotted)]
    np.testing.assert_allclose(slopes, [1.0, 2.0])


def test_errors_of_the_bent_plate_stand_over_the_spacing(full):
    found = full["tl_bending"]
    panels = drawn(total_lagrangian.bending_energy, found).axes
    metrics = {"bending_energy_error": 100.0, "end_angle_error_2d": 1.0}
    for axes, (metric, factor) in zip(panels, metrics.items(), strict=True):
        cells = found.select({"h": 1.7}, "grid")
        expected = [1e3 / 12.0 / cells["n"], factor * cells[metric]]
        np.testing.assert_allclose(line(axes, "$\\tilde{h} = 1.7$"), expected)
        assert axes.get_xlim()[0] == 0.0


@pytest.mark.parametrize("mode", [1, 2])
def test_what_first_order_leaves_at_zero_is_marked(mode, full):
    found, roman = full[f"tl_mode{mode}"], "I" * mode
    left, everywhere = -2e-4, found.table["h"] > 0.0
    errors = left + 3.0 * found.table["spacing"]
    given = changed(found, everywhere, **{f"K_{roman}_integral_error": errors})
    drawing = drawn(f"total_lagrangian.mode{mode}_stress_intensity", given)
    axes, zero = drawing.axes
    n = np.array([40, 50, 60, 80, 120])
    spacing, shown = line(axes, f"$K_\\mathrm{{{roman}}}$")
    np.testing.assert_allclose(spacing, 200.0 / n)
    np.testing.assert_allclose(shown, 100.0 * (left + 0.6 / n))
    straight = next(one.get_xydata() for one in axes.get_lines() if one.get_linestyle() == "-")
    np.testing.assert_allclose(straight, [[0.0, 100.0 * left], [5.0, 100.0 * (left + 0.015)]])
    np.testing.assert_allclose(zero.get_lines()[0].get_xydata(), [[0.0, 100.0 * left]], atol=1e-9)


def test_the_spacing_needs_the_h_that_is_refined(full):
    found = full["tl_mode1"]
    with pytest.raises(Missing, match=r"h=1\.3"):
        drawn(
            "total_lagrangian.mode1_stress_intensity",
            changed(found, found.table["h"] == 1.3, G1_error=np.nan),
        )


def test_one_resolution_is_drawn_without_a_limit(full):
    found = full["tl_mode1"]
    gone = found.table["n"] != 40
    axes, zero = drawn(
        "total_lagrangian.mode1_stress_intensity",
        changed(found, gone, G1_error=np.nan, J_error=np.nan, K_I_integral_error=np.nan),
    ).axes
    assert len(line(axes, "$J$")[0]) == 1
    # The zero line alone.
    assert len(zero.get_lines()) == 1


def test_the_deformed_square_is_that_of_the_method(full, records):
    for mode, component in ((1, "yy"), (2, "xy")):
        definition = figure.find(f"total_lagrangian.mode{mode}_field")
        state = records[f"mode{mode}", "tl"].isel(snapshot=1)
        places, field = centres(drawn(definition, full[f"tl_mode{mode}"]).axes[0])
        np.testing.assert_allclose(places, np.column_stack((state["x"].values, state["y"].values)))
        np.testing.assert_allclose(field.get_array(), state[f"stress_{component}"].values / 1e3)
        assert definition.number != figure.find(f"crack_field.mode{mode}_field").number
