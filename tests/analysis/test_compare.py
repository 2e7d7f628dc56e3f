"""Which cell of one dataset stands for which of another."""

from sphstudy.analysis.compare import _agree


def test_a_cell_is_its_coordinates():
    settings = {"h": 1.3, "n": 40, "method": "tl", "method.hourglass": 1.0}
    assert _agree(settings, {"h": 1.3, "n": 40.0})
    assert not _agree(settings, {"h": 1.5, "n": 40})
    assert not _agree(settings, {"h": 1.3, "method": "thesis"})


def test_a_setting_that_a_point_does_not_have_is_no_match_for_a_value_of_it():
    """Or a cell of an option that was withdrawn would be judged by a point without it."""
    settings = {"h": 1.3, "n": 40}
    assert not _agree(settings, {"h": 1.3, "method.visibility": "exclusive"})
    assert _agree(settings, {"h": 1.3, "scene.columns": "null"})
