"""The stability map: places of runs by case and method, tables, figure, pictures, the command."""

from dataclasses import replace

import matplotlib.style
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection
from PIL import Image, ImageSequence

from sphstudy import catalogue
from sphstudy.__main__ import main
from sphstudy.analysis.results import Missing
from sphstudy.analysis.stability.bounds import Quoted
from sphstudy.analysis.stability.cases import by_place, judged
from sphstudy.configuration.composition import session
from sphstudy.report import figure, page, panels, render, stability_tables
from sphstudy.report.figures import hard_cases, stability
from sphstudy.report.stability_tables import bounds, counts, quoted, stability_map
from tests.report.sample import Reader
from tests.support.figures import drawn
from tests.support.records import SAMPLES, two_particles
from tests.support.results import altered, stored

STUDY = """
title: Hard cases
judged: true
choices: []
blocks:
  grid: {scene: plate, method: [thesis, tl], h: [1.3, 1.5], n: 5, scene.H0: [0.02, 0.1], record.frames: 4}
  repaired: {scene: plate, method: thesis, h: 1.5, n: 5, method.artificial_stress: 0.3}
  steps: {scene: plate, method: tl, h: 1.5, n: 5, scene.H0: 0.1, solve.courant: [0.8, 1.5]}
  bent: {scene: bending, method: tl, h: 1.5, n: 5, method.law: svk}
figures: [stability.map, hard_cases.stress.plate, hard_cases.motion.plate, hard_cases.pressures.bending]
"""
TIME = np.arange(float(SAMPLES))
BROKEN = {"largest_speed": np.where(TIME < 4.0, 0.0, 1e6)}
MOVED = np.array(((0.5, 1.5), (0.0, 0.25)))


def make(point, config):
    """thesis, h = 1.3: degraded; with H0 = 0.1: diverged at 1.5, missing at 1.3. Bending: failed. The
    second of two runs that share a place: degraded.
    """
    flat = config.flat()
    if flat["scene"] == "bending":
        return two_particles(config, "failed", message="ValueError")
    if flat["method"] == "thesis" and flat["scene.H0"] == 0.1:
        states = [(0.0, np.eye(2)), (3.0, 9.0 * MOVED)]
        return (
            two_particles(config, "diverged", message="a step too far", states=states)
            if flat["h"] == 1.5
            else None
        )
    states = [(t, np.eye(2) + 0.1 * t * MOVED) for t in (0.0, 2.0, 4.0, 6.0)]
    alone = flat["record.frames"] == 0 and flat["solve.courant"] == 0.8 and flat["method"] == "tl"
    broken = alone or (flat["method"], flat["h"]) == ("thesis", 1.3)
    return two_particles(config, states=states, **(BROKEN if broken else {}))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("map")


@pytest.fixture(scope="module")
def found(folder):
    with session() as hydra, pytest.MonkeyPatch.context() as patch:
        return stored(folder, patch, hydra, STUDY, make)


def test_runs_are_placed_by_what_tells_them_apart(found):
    cases = judged(found)
    assert len(cases) == 12  # the steps of usual size are the grid's, but for their frames
    grid = by_place(cases)
    assert list(grid.index) == ["plate, H0 0.02", "plate, H0 0.1", "bending"]
    assert list(grid.columns) == [
        ("thesis", 1.3), ("thesis", 1.5), ("thesis, artificial stress 0.3", 1.5),
        ("tl", 1.3), ("tl", 1.5), ("tl, courant 1.5", 1.5), ("tl, svk", 1.5),
    ]  # fmt: skip
    outcomes = [[cases[k].judgement.outcome if k >= 0 else "" for k in row] for row in grid.to_numpy()]
    assert outcomes == [
        ["degraded", "done", "done", "done", "done", "", ""],
        ["missing", "diverged", "", "done", "degraded", "done", ""],
        ["", "", "", "", "", "", "failed"],
    ]


def test_the_map_is_a_table(found):
    table = stability_map(judged(found))
    texts = [[cell.text for cell in row] for row in table.rows]
    assert all(len(row) == len(table.columns) for row in table.rows)
    degraded = next(row for row in texts if row[4] == "degraded")
    assert degraded[:4] == ["plate", "H0 0.02", "thesis", "1.300"]
    assert degraded[5:9] == ["4", "speed", "96\u202f437", "at most 1"]
    diverged = next(row for row in texts if row[4] == "diverged")
    assert (diverged[5], diverged[6], diverged[9]) == ("10", "", "a step too far")
    assert counts(judged(found)) == "7 done, 2 degraded, 1 diverged, 1 missing, 1 failed"


def test_the_bounds_stand_with_their_reasons(found):
    table = bounds(judged(found))
    (speed,) = [[cell.text for cell in row] for row in table.rows if row[1].text == "speed"]
    assert speed[:5] == ["any", "speed", "at most 1", "", "2 of 10"]
    assert all(row[5].text and row[6].text for row in table.rows)
    # Nothing of these has a mirror, which need not be said run by run.
    assert all("mirror" not in row[-1].text for row in stability_map(judged(found)).rows)


def test_what_others_found_stands_beside_what_is_found_here(found, monkeypatch):
    assert quoted(found, judged(found)) is None
    one = Quoted(quantity="period", units="s", between=(0.283, 0.285), source="a paper")
    monkeypatch.setattr(stability_tables, "read_quoted", lambda scene: [one] if scene == "plate" else [])
    period = np.where(found.table["method"] == "tl", 0.25 + 0.01 * found.table["scene.H0"], np.nan)
    with_period = altered(found, table=found.table.assign(period=period))
    (row,) = quoted(with_period, judged(found)).rows
    assert [cell.text for cell in row] == [
        "plate", "period (s)", "0.2830 to 0.2850", "a paper",
        "tl: 0.2502 to 0.2510; tl, courant 1.5: 0.2510",
    ]  # fmt: skip
    (row,) = quoted(found, judged(found)).rows
    assert row[-1].text == "–"


def test_the_figure_shows_every_run_in_its_place(found):
    axes = drawn("stability.map", found).axes[0]
    assert len(axes.patches) == 12 - 1  # two runs share a place
    written = {
        (round(t.get_position()[0], 1), round(t.get_position()[1], 1)): t.get_text() for t in axes.texts
    }
    assert written[0.5, 0.3].endswith(" 4")
    assert written[0.5, 0.7] == "speed"
    assert written[1.5, 1.3].endswith(" 10")
    assert written[6.5, 2.7] == "failed"
    empty = altered(found, record=lambda row: None)
    with pytest.raises(Missing, match="no run is stored"):
        drawn("stability.map", empty)


def test_many_cases_are_drawn_on_a_page(found):
    cases = [case for case in judged(found) if case.scene == "plate"]
    many = [replace(case, scene=f"case_{k}") for case in cases for k in range(8)]
    with matplotlib.style.context(figure.STYLE):
        drawing = stability.matrix(many)
        drawing.canvas.draw()
    axes = drawing.axes[0]
    assert len(axes.get_yticks()) == 16
    width, height = drawing.get_size_inches()
    assert width < 8.0
    assert height < 8.0
    # A cell is as large as what is written in it.
    for text in axes.texts:
        if text.get_position()[1] > 0.0:
            box = text.get_window_extent().transformed(axes.transData.inverted())
            assert abs(box.width) < 1.0
            assert abs(box.height) < 0.5


def test_pictures_show_where_particles_are_at_last(found):
    picture = drawn("hard_cases.stress.plate", found)
    bodies = [c for axes in picture.axes for c in axes.collections if isinstance(c, EllipseCollection)]
    assert len(bodies) == 7
    titles = [axes.get_title() for axes in picture.axes[:7]]
    (k,) = [k for k, title in enumerate(titles) if "diverged" in title]
    assert titles[k].startswith("H0 0.1, thesis")
    assert "last good state, t = 3 s" in titles[k]
    np.testing.assert_allclose(bodies[k].get_offsets(), 9.0 * MOVED.T)
    np.testing.assert_allclose(bodies[0].get_offsets(), (np.eye(2) + 0.6 * MOVED).T)
    # View and colours are those of sound runs; plane strain: σzz = 0.3 σxx.
    assert picture.axes[0].get_xlim()[1] < 5.0
    highest = bodies[k].get_clim()[1]
    assert highest == pytest.approx(2.003 * np.sqrt(0.5 * (1.0 + 0.3**2 + 0.7**2)), rel=1e-3)


@pytest.mark.parametrize(
    ("cases", "slender", "columns", "places"),
    [
        ("aaa", False, 3, [0, 1, 2]),
        ("aaa", True, 1, [0, 1, 2]),
        ("aaaa", False, 2, [0, 1, 2, 3]),
        ("aabb", True, 2, [0, 1, 2, 3]),
        ("abbcc", False, 2, [0, 2, 3, 4, 5]),
        ("aaabb", False, 3, [0, 1, 2, 3, 4]),
        ("aaaab", False, 3, [0, 1, 2, 3, 4]),
    ],
)
def test_cases_stand_below_each_other_if_there_is_room(cases, slender, columns, places):
    shown = [panels.Shown(None, case, "", "done") for case in cases]
    assert panels._arranged(shown, slender) == (columns, places)


def test_an_animation_goes_through_the_states(found, tmp_path):
    table = found.table[(found.table["method"] == "tl") & (found.table["solve.courant"] == 0.8)]
    definition = replace(found.definition, figures=["hard_cases.motion.plate"])
    few = altered(found, table=table[table["scene.H0"] == 0.02], definition=definition)
    moving = drawn("hard_cases.motion.plate", few)
    assert moving.frames == 4
    (body,) = moving.figure.axes[0].collections
    for k, time in enumerate((0.0, 2.0, 4.0, 6.0)):
        moving.draw(k)
        np.testing.assert_allclose(body.get_offsets(), (np.eye(2) + 0.1 * time * MOVED).T)
        assert f"t = {time:g} s" in moving.figure.axes[0].get_title()
    (drawing,) = render.draw_all(few, tmp_path)
    assert (drawing.error, drawing.format) == ("", "gif")
    gif = tmp_path / "hard_cases.motion.plate.gif"
    with Image.open(gif) as image:
        frames = [np.asarray(frame.convert("L"), int) for frame in ImageSequence.Iterator(image)]
    assert len(frames) == 4
    assert all((frames[k] != frames[k + 1]).any() for k in range(3))
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".gif", ".png"]


def test_more_panels_than_can_be_read_are_refused(found, monkeypatch):
    monkeypatch.setattr(hard_cases, "_MOST", 6)
    with pytest.raises(ValueError, match="7 runs of scene plate keep frames; a figure shows 6"):
        drawn("hard_cases.stress.plate", found)


def test_a_scene_without_frames_has_no_pictures(found):
    with pytest.raises(Missing, match="scene bending"):
        drawn("hard_cases.pressures.bending", found)
    for name in ("hard_cases.stress", "stability.map.plate", "hard_cases.none.plate"):
        with pytest.raises(figure.ConfigurationError, match=f"unknown figure '{name}'"):
            figure.find(name)


def test_the_page_has_the_map(found, folder, tmp_path, monkeypatch):
    monkeypatch.setitem(catalogue.FOLDERS, "studies", folder)
    plain = altered(found, definition=replace(found.definition, figures=[]))
    read = Reader(page.write(plain, tmp_path).read_text(encoding="utf-8"))
    assert "made_up-stability" in read.ids
    assert len(read.tables["Stability map"][1]) == 12
    assert "Bounds of a sound run" in read.tables
    plain = altered(plain, definition=replace(plain.definition, judged=False))
    assert "Stability map" not in page.write(plain, tmp_path).read_text(encoding="utf-8")


def test_the_command_prints_the_map(found, folder, monkeypatch, capsys):
    monkeypatch.setitem(catalogue.FOLDERS, "studies", folder)
    assert main(["judge", "made_up", f"results={folder / 'results'}"]) == 0
    said = capsys.readouterr().out
    assert "judged: 7 done, 2 degraded, 1 diverged, 1 missing, 1 failed" in said
    assert "Bounds of a sound run" in said
    assert main(["judge"]) == 2
    assert "judge: name one of" in capsys.readouterr().err
