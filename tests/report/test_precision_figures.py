"""Figures and tables of work and precision show what is stored, failed points included."""

import numpy as np
import pytest

from sphstudy.analysis import results, work_precision
from sphstudy.analysis.results import Missing
from sphstudy.configuration.composition import session
from sphstudy.report import cheapest
from sphstudy.report.figures import precision as figures
from tests.support.figures import drawn
from tests.support.results import altered

SCENES = {
    "plate": "precision.plate",
    "bending": "precision.bending",
    "mode1": "precision.mode1",
    "mode2": "precision.mode2",
}


@pytest.fixture(scope="module")
def empty(tmp_path_factory):
    """The study with nothing stored."""
    with session() as hydra:
        return results.load("precision", hydra, [], str(tmp_path_factory.mktemp("empty")))


@pytest.fixture(scope="module")
def full(empty):
    """The same with made-up numbers: errors of first order in 1/n, costs that grow with n."""
    found = altered(empty)
    table = empty.table.assign(status="done", steps=100.0, compile_seconds=3.0)
    table["particles"] = 12.0 * table["n"] ** 2
    table["cpu_seconds"] = 1e-5 * table["particles"] * table["h"]
    for metric in work_precision.ERRORS.values():
        table[metric] = -table["h"] / table["n"]
    beyond = table["block"].str.endswith("beyond")
    table.loc[beyond, "status"] = "diverged"
    found.table = table
    return found


@pytest.mark.parametrize("scene", SCENES)
def test_every_point_is_there_at_its_cost(scene, full):
    axes = drawn(SCENES[scene], full).axes[0]
    own = full.table[full.table["scene"] == scene].drop_duplicates("record")
    done, failed = own[own["status"] == "done"], own[own["status"] == "diverged"]
    marks = [one for one in axes.get_lines() if one.get_linestyle() == "None"]
    shown = [tuple(p) for one in marks if one.get_marker() != "x" for p in one.get_xydata()]
    expected = zip(done["cpu_seconds"], 100.0 * done["h"] / done["n"], strict=True)
    np.testing.assert_allclose(sorted(shown), sorted(expected))
    crosses = np.concatenate([one.get_xydata() for one in marks if one.get_marker() == "x"])
    np.testing.assert_allclose(sorted(crosses[:, 0]), sorted(failed["cpu_seconds"]))
    assert crosses[:, 1].min() > max(y for _, y in shown)
    assert axes.get_title("right") == "compilation, apart: up to 3 s"


def test_lucky_points_are_hollow_and_not_on_the_front(full):
    found = altered(full)
    lucky = (full.table["solve"] == "modes") & (full.table["h"] == 1.3) & (full.table["n"] == 7)
    found.table.loc[lucky, "frequency_error_2d"] = 1e-6
    axes = drawn("precision.plate", found).axes[0]
    white = [one for one in axes.get_lines() if one.get_markerfacecolor() == "white"]
    (point,) = np.concatenate([one.get_xydata() for one in white])
    assert point[1] == pytest.approx(1e-4)
    steps = next(one for one in axes.get_lines() if one.get_drawstyle() == "steps-post")
    assert min(steps.get_ydata()) > 1e-3


def test_an_empty_store_is_said_to_lack_data(empty):
    for definition in (*SCENES.values(), figures.predicted_cost):
        with pytest.raises(Missing):
            drawn(definition, empty)
    assert cheapest.tables(empty) == []


def test_predictions_are_counted(full):
    axes = drawn(figures.predicted_cost, full).axes[0]
    total = full.table[full.table["status"] == "done"]["record"].nunique()
    assert sum(len(one.get_xdata()) for one in axes.get_lines()) - 2 == total
    assert f"of {total} runs within 30 %" in axes.get_title()


def test_a_table_for_each_scene_names_the_cheapest(full):
    found = cheapest.tables(full)
    assert len(found) == len(SCENES)
    plate = next(one for one in found if "scene plate" in one.caption)
    assert [row[0].text for row in plate.rows] == ["5", "1", "0.100", "0.0100"]
    points = work_precision.points(full.table, "plate")
    choice = work_precision.cheapest(points, 0.05)
    assert plate.rows[0][1].text == work_precision.label(choice.row)
    assert plate.rows[0][4].text == "confirmed by all finer resolutions"
    assert plate.rows[2][1].text == cheapest.NONE
