"""Study files: blocks, inclusion, and what is refused."""

import pytest
import yaml

from sphstudy import catalogue
from sphstudy.__main__ import main
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.configuration.study_points import StudyPoints, all_points
from sphstudy.errors import ConfigurationError


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setitem(catalogue.FOLDERS, "studies", tmp_path)
    return tmp_path


def test_shipped_studies_make_the_points_of_the_thesis():
    with session() as hydra:
        counts = {name: len(all_points(hydra, name, [])[0]) for name in study_file.names()}
    assert counts["mode1"] == counts["mode2"] == 12
    assert counts["plate"] == 12 + 3  # and three with artificial stress, for figure 4.1
    assert counts["thesis"] == 12 + 12 + 15 + 1
    assert all(counts.values())


def test_speed_is_a_command_that_study_knows_too(capsys):
    """It measures instead of running points: there is no file of that name, and it is no study."""
    assert main(["study", "speed", "--dry-run"]) == 0
    measured = capsys.readouterr().out
    assert main(["speed", "--dry-run"]) == 0
    assert capsys.readouterr().out == measured
    assert main(["list"]) == 0
    listed = capsys.readouterr().out.partition("studies:\n")[2].splitlines()
    heads = [line for line in listed if not line.startswith(3 * " ")]  # a long title takes more lines
    assert [line.split()[0] for line in heads] == study_file.names()
    assert main(["report", "speed"]) == 2
    assert "`sphstudy speed` measures this machine" in capsys.readouterr().err


def test_overrides_replace_settings_of_every_block():
    with session() as hydra:
        points, _, _ = all_points(hydra, "mode1", ["n=20"])
    assert {p.config.n for p in points} == {20}
    assert len(points) == 4


def test_a_block_can_vary_its_settings_one_at_a_time(folder):
    (folder / "one.yaml").write_text(
        "title: a\nblocks: {b: {scene: plate, n: 5, vary: {h: [1.3, 1.7], scene.plane: stress}}}\n"
    )
    with session() as hydra:
        points = StudyPoints(hydra, "one", []).blocks["b"]
    found = [(p.config.h, p.config.scene.plane) for p in points]
    assert found == [(1.5, "strain"), (1.3, "strain"), (1.7, "strain"), (1.5, "stress")]


def test_invalid_cells_are_refused_or_left_out_where_the_study_says_so(folder):
    text = "title: a\nblocks: {b: {scene: plate, n: [5, 6], h: [0.4, 1.5]}}\n"
    (folder / "strict.yaml").write_text(text)
    (folder / "lenient.yaml").write_text(text + "skip_invalid: true\n")
    with session() as hydra:
        with pytest.raises(ConfigurationError, match=r"n=6: must be odd"):
            all_points(hydra, "strict", [])
        points, _, skipped = all_points(hydra, "lenient", [])
    assert [(p.config.h, p.config.n) for p in points] == [(1.5, 5)]
    assert len(skipped) == 4  # two of them for the cell that is wrong in both


def test_leaving_out_invalid_cells_does_not_hide_wrong_settings(folder):
    text = "title: a\nblocks: {b: {scene: plate, n: 5, hh: 1}}\nskip_invalid: true\n"
    (folder / "wrong.yaml").write_text(text)
    with session() as hydra, pytest.raises(ConfigurationError, match="unknown setting"):
        all_points(hydra, "wrong", [])


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("title: a\nblocks: {b: {h: [1.3, {}]}}\n", "blocks"),
        ("title: a\nblock: []\n", "block"),
        ("blocks: {}\n", "title"),
        ("title: [", "expected"),
        ("- 1\n", "bad.yaml"),
        ("title: a\n", "no points"),
        ("title: a\ninclude: [bad]\n", "includes itself"),
        ("title: a\ninclude: [gone]\n", "unknown study 'gone'; there are bad"),
        ("title: a\nblocks: {b: {scene: foo}}\n", "unknown scene 'foo'"),
    ],
)
def test_wrong_files_are_refused_with_a_reason(folder, text, complaint):
    (folder / "bad.yaml").write_text(text)
    with session() as hydra, pytest.raises(ConfigurationError, match=complaint):
        all_points(hydra, "bad", [])


def test_a_million_points_are_refused_before_any_is_composed(folder):
    lists = {key: list(range(10)) for key in ("seed", "scene.rho", "scene.E", "n", "scene.L", "h")}
    (folder / "tiny.yaml").write_text(yaml.safe_dump({"title": "huge", "blocks": {"all": lists}}))
    with session() as hydra, pytest.raises(ConfigurationError, match="1,000,000 points"):
        all_points(hydra, "tiny", [])
