"""Settings in a folder of the user's are found beside the package's."""

import pytest

from sphstudy import catalogue
from sphstudy.analysis.stability.bounds import for_point
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError

OWN = """\
# @package _global_
defaults: [plate, _self_]
scene: {periods: 0.5}
metrics: [oscillation, balance]
headline: [energy_drift]
protocol:
  thesis: {explicit: {solve: {courant: 0.4}, method: {damping: 0.5}}}
source: a notebook
bounds:
  energy_drift: {at_most: 0.1, reason: a guess}
"""

METHOD = """\
defaults: [tl, _self_]
hourglass: 0.5
protocol:
  plate: {explicit: {solve: {courant: 0.3}, method: {damping: 0.25}, record: {frames: 4}}}
"""


@pytest.fixture
def own(tmp_path, monkeypatch):
    monkeypatch.setenv("SPHSTUDY_CONFIG_DIR", "")
    (tmp_path / "scene").mkdir()
    (tmp_path / "scene" / "short.yaml").write_text(OWN)
    return tmp_path


def test_a_scene_of_the_user_is_found_in_a_folder_of_settings(own):
    with session(str(own)) as opened:
        config = opened.points(["scene=short"], sweep=False)[0][0].config
        assert str(own) in opened.search_path()[1]
        assert opened.composed(["scene=short", "n=5"])["scene"]["periods"] == 0.5
    assert (config.scene.name, config.scene.periods, config.scene.nu) == ("short", 0.5, 0.3)
    assert (config.solve.courant, config.method.damping) == (0.4, 0.5)


def test_lists_and_bounds_of_a_user_s_scene_are_found_after_the_session(own):
    with session(str(own)):
        pass
    assert catalogue.metrics("short") == ("oscillation", "balance")
    assert catalogue.headline("short", "explicit") == ("energy_drift",)
    (bound,) = (b for b in for_point("short", {}) if not b.general)
    assert (bound.quantity, bound.at_most, bound.source) == ("energy_drift", 0.1, "a notebook")


def test_a_method_of_the_user_brings_its_protocol(own):
    (own / "method").mkdir()
    (own / "method" / "soft.yaml").write_text(METHOD)
    with session(str(own)) as opened:
        config = opened.points(["scene=plate", "method=soft"], sweep=False)[0][0].config
        other = opened.points(["scene=short", "method=soft"], sweep=False)[0][0].config
        (given,), _ = opened.points(["scene=plate", "method=soft", "method.damping=1"], sweep=False)
    assert (config.method.name, config.method.kind, config.method.hourglass) == (
        "soft", "total_lagrangian", 0.5
    )  # fmt: skip
    assert (config.solve.courant, config.method.damping, config.record.frames) == (0.3, 0.25, 4)
    assert (other.solve.courant, other.method.damping, other.record.frames) == (0.8, 0.0, 0)
    assert given.config.method.damping == 1.0


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("recrod: {samples: 10}", "unknown section of scene bad 'recrod'; did you mean 'record'?"),
        ("protocol: {thesis: {explicit: {solve: {curant: 1}}}}", "solve.curant=1: there is no such key"),
        ("protocol: {thesis: {explicit: 0.4}}", "protocol.thesis.explicit: should be settings by part"),
        ("protocol: {thesis: 3}", "should be settings by part"),
        ("scene: 3", "scene/bad.yaml: sets nothing of the scene"),
        ("scene: {periods: long}", "scene.periods=long: should be a valid number"),
    ],
)
def test_wrong_sections_of_a_scene_are_named(own, text, complaint):
    lines = "# @package _global_\ndefaults: [plate, _self_]\n"
    (own / "scene" / "bad.yaml").write_text(lines + text + "\n")
    with session(str(own)) as opened, pytest.raises(ConfigurationError) as error:
        opened.points(["scene=bad"], sweep=False)
    assert complaint in str(error.value)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("defaults: [gone, _self_]", "unknown scene 'gone'"),
        ("defaults: [/method/tl]", "defaults: /method/tl is no name of a scene"),
        ("defaults: [bad]", "defaults: bad is no name of a scene"),
        ("defaults: [short]", "scene/short.yaml: defaults: bad is no name of a scene"),
        ("- 1", "scene/bad.yaml: should be a mapping"),
        ("a: [", "scene/bad.yaml: while parsing"),
        ("metrics: 3", "scene/bad.yaml: metrics: should be a list"),
    ],
)
def test_wrong_files_are_refused_by_name(own, text, complaint):
    catalogue.add_settings(own)
    (own / "scene" / "bad.yaml").write_text(text)
    (own / "scene" / "short.yaml").write_text("defaults: [bad, _self_]")
    with pytest.raises(ConfigurationError) as error:
        catalogue.metrics("bad")
    assert complaint in str(error.value)


def test_a_folder_of_settings_that_does_not_exist_is_refused(own):
    with pytest.raises(ConfigurationError, match="gone: there is no such folder"), session("gone"):
        pass


def test_the_search_path_can_be_given_as_an_override(own):
    with session() as opened:
        (point,), _ = opened.points(["scene=short", f"hydra.searchpath=[{own}]"], sweep=False)
    assert point.config.scene.name == "short"


@pytest.mark.parametrize("given", ["[/nowhere/at/all]", "[pkg://os]", "7", "[${oc.env:HOME}]", "["])
def test_a_search_path_that_is_no_list_of_folders_is_refused(own, given):
    with (
        session() as opened,
        pytest.raises(ConfigurationError, match=r"/nowhere|write hydra.searchpath="),
    ):
        opened.points([f"hydra.searchpath={given}"], sweep=False)
