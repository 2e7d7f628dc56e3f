"""Bounds are read with their reasons, or refused by file and key."""

import numpy as np
import pytest

from sphstudy import catalogue
from sphstudy.analysis.stability import bounds
from sphstudy.analysis.stability.bounds import Bound, for_point
from sphstudy.analysis.stability.indicators import INDICATORS
from sphstudy.errors import ConfigurationError

GOOD = "source: a paper\nbounds:\n  rebound: {at_least: 0.4, at_most: 1, reason: elastic}\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Scenes of a user's, before the package's."""
    (tmp_path / "scene").mkdir()
    monkeypatch.setenv("SPHSTUDY_CONFIG_DIR", str(tmp_path))
    return tmp_path / "scene"


def bound(**limits):
    given = {"at_most": None, "at_least": None} | limits
    return Bound(quantity="q", **given, where={}, reason="", source="", general=False)


@pytest.mark.parametrize("scene", catalogue.names("scene"))
def test_bounds_of_all_scenes_are_sound(scene):
    assert [b.quantity for b in for_point(scene, {}) if b.general]
    own = [b for b in for_point(scene, {}) if not b.general]
    assert bool(own) == ("bounds" in catalogue.settings("scene", scene))


def test_a_scene_without_bounds_or_a_file_has_the_general_ones():
    assert all(b.general for scene in ("plate", "gone") for b in for_point(scene, {}))


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("bounds: {}\n", "source: "),
        ("source: s\n", "bounds: "),
        ("source: s\nbounds: 3\n", "bounds: "),
        (
            "source: s\nbounds: {}\nquoted: [{quantity: a, units: s, between: [1], source: b}]\n",
            "quoted.0.between",
        ),
        ("source: [\n", "expected"),
        ("", "dictionary"),
        (
            "source: s\nbounds: {history.sped: {at_most: 1, reason: r}}\n",
            "history.sped: unknown indicator 'sped'; did you mean 'speed'?",
        ),
        ("source: s\nbounds: {a: {at_most: 1}}\n", "a: reason: "),
        ("source: s\nbounds: {a: {at_most: 1, reason: ' '}}\n", "a: reason: is empty"),
        ("source: s\nbounds: {a: {reason: r}}\n", "a: neither at_most nor at_least"),
        ("source: s\nbounds: {a: {at_most: 1, at_least: 2, reason: r}}\n", "a: at_most is less"),
        ("source: s\nbounds: {a: {at_most: much, reason: r}}\n", "a: at_most: "),
        ("source: s\nbounds: {a: {at_most: .nan, reason: r}}\n", "a: at_most: "),
        ("source: s\nbounds: {a: {most: 1, reason: r}}\n", "a: most: "),
        ("source: s\nbounds: {a: 3}\n", "a: should be a mapping"),
        ("source: s\nbounds: {a: [{at_most: 1, reason: r}, 3]}\n", "a: should be a mapping"),
    ],
)
def test_a_wrong_file_is_refused_by_file_and_key(text, complaint, folder):
    (folder / "rings.yaml").write_text(text)
    with pytest.raises(ConfigurationError) as raised:
        for_point("rings", {})
    (said,) = raised.value.complaints
    assert said.startswith("scene/rings.yaml: ")
    assert complaint in said


def test_every_complaint_is_made_at_once(folder):
    (folder / "rings.yaml").write_text("source: s\nbounds: {a: {at_most: 1}, history.b: {reason: r}}\n")
    with pytest.raises(ConfigurationError) as raised:
        for_point("rings", {})
    assert len(raised.value.complaints) == 3


def test_all_files_are_checked_together(folder):
    bounds.check()
    for name in ("one", "two"):
        (folder / f"{name}.yaml").write_text("source: s\n")
    with pytest.raises(ConfigurationError) as raised:
        bounds.check()
    assert [c.partition(":")[0] for c in raised.value.complaints] == [
        "scene/one.yaml",
        "scene/two.yaml",
    ]


def test_a_scene_inherits_bounds_and_replaces_them_quantity_by_quantity(folder):
    (folder / "parent.yaml").write_text(GOOD + "  torn: {at_most: 0, reason: r}\n")
    (folder / "child.yaml").write_text(
        "defaults: [parent, _self_]\nbounds:\n  rebound: {at_least: 0.2, reason: softer}\n"
    )
    own = {b.quantity: b for b in for_point("child", {}) if not b.general}
    assert list(own) == ["rebound", "torn"]
    assert (own["rebound"].at_least, own["rebound"].at_most) == (0.2, None)
    assert own["rebound"].source == "a paper"


def test_a_scene_adds_to_the_general_bounds_and_replaces_them(folder):
    general = "history.speed: {at_most: 1, reason: c0}, rebound: {at_most: 9, reason: r}"
    (folder.parent / "bounds.yaml").write_text(f"source: g\nbounds: {{{general}}}\n")
    (folder / "rings.yaml").write_text(GOOD)
    rings, other = for_point("rings", {}), for_point("plate", {})
    assert [(b.quantity, b.at_most, b.general) for b in rings] == [
        ("rebound", 1, False),
        ("history.speed", 1, True),
    ]
    assert [(b.quantity, b.at_most) for b in other] == [("history.speed", 1), ("rebound", 9)]
    assert (rings[0].source, rings[0].reason, rings[0].interval) == (
        "a paper",
        "elastic",
        "at least 0.4, at most 1",
    )
    assert [b.indicator for b in rings] == ["", "speed"]


def test_a_bound_may_be_for_some_points_only(folder):
    (folder.parent / "bounds.yaml").write_text("source: g\nbounds: {}\n")
    (folder / "rings.yaml").write_text(
        "source: s\nbounds:\n  error:\n    - {where: {n: [5, 10]}, at_most: 0.013, reason: r}\n"
        "    - {where: {n: 20, method: tl}, at_most: 0.003, reason: r}\n"
    )
    found = [
        [b.at_most for b in for_point("rings", {"n": n, "method": method})]
        for n, method in ((10, "thesis"), (20, "thesis"), (20, "tl"), (40, "tl"))
    ]
    assert found == [[0.013], [], [0.003], []]


def test_excess_is_the_distance_outside():
    values = np.array((-1.0, 0.25, 3.0, np.nan))
    np.testing.assert_array_equal(bound(at_most=1.0).excess(values), values - 1.0)
    np.testing.assert_array_equal(bound(at_least=0.0).excess(values), -values)
    np.testing.assert_array_equal(bound(at_most=1.0, at_least=0.0).excess(values)[:3], (1.0, -0.25, 2.0))


def test_what_others_found_is_read(folder):
    assert bounds.quoted("plate") == []
    said = "{quantity: period, units: s, between: [0.283, 0.285], source: a paper}"
    (folder / "rings.yaml").write_text(f"{GOOD}quoted: [{said}]\n")
    (one,) = bounds.quoted("rings")
    assert (one.quantity, one.units, one.between, one.source) == (
        "period",
        "s",
        (0.283, 0.285),
        "a paper",
    )


def test_every_indicator_says_what_it_is():
    assert all(meaning for meaning, _ in INDICATORS.values())
