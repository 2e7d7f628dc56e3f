"""Settings in a folder of the user's are found beside the package's."""

import pytest

from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError

OWN = """\
# @package _global_
defaults: [plate, _self_]
scene: {periods: 0.5}
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
