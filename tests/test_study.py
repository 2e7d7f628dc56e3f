"""Study files: blocks, inclusion, and what is refused."""

import pytest

from sphstudy import study
from sphstudy.batch import study_points
from sphstudy.composition import session
from sphstudy.config import ConfigurationError


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(study, "folder", lambda: tmp_path)
    return tmp_path


def test_shipped_studies_make_the_points_of_the_thesis():
    with session() as hydra:
        counts = {name: len(study_points(hydra, name, [])[0]) for name in study.names()}
    assert counts == {"bending": 1, "mode1": 12, "mode2": 12, "plate": 12, "thesis": 37}


def test_overrides_replace_settings_of_every_block():
    with session() as hydra:
        points, _ = study_points(hydra, "mode1", ["n=20"])
    assert {p.config.n for p in points} == {20}
    assert len(points) == 4


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("title: a\nblocks: [{h: [1.3, {}]}]\n", "blocks"),
        ("title: a\nblock: []\n", "block"),
        ("blocks: []\n", "title"),
        ("title: [", "expected"),
        ("- 1\n", "bad.yaml"),
        ("title: a\n", "no points"),
        ("title: a\ninclude: [bad]\n", "includes itself"),
        ("title: a\ninclude: [gone]\n", "there is bad"),
        ("title: a\nblocks: [{scene: foo}]\n", "scene=foo"),
    ],
)
def test_wrong_files_are_refused_with_a_reason(folder, text, complaint):
    (folder / "bad.yaml").write_text(text)
    with session() as hydra, pytest.raises(ConfigurationError, match=complaint):
        study_points(hydra, "bad", [])
