"""The pulled bar: where its particles are, what drives them, and what becomes of it."""

from functools import lru_cache

import numpy as np
import pytest

import sphstudy
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.model.scenes import tension


@lru_cache
def configured(*settings):
    """The configuration of a run with these settings."""
    with session() as hydra:
        return hydra.points(["h=1.3", *settings], sweep=False)[0][0].config


def test_the_bar_is_a_lattice_and_noise():
    config = configured("scene=tension")
    body = tension.build(config).body
    assert body.x.size == tension.particles(config) == 44 * 11
    assert body.spacing_x == body.spacing_y == pytest.approx(0.25 / 11)
    assert body.mass.sum() == pytest.approx(7750.0 * 1.0 * 0.25)
    lattice = body.spacing_x * (body.sites - np.array([[21.5], [5.0]]))
    off = np.abs(np.stack((body.x, body.y)) - lattice) / body.spacing_x
    assert 0.99e-3 < off.max() <= 1e-3
    assert off.mean() == pytest.approx(0.5e-3, rel=0.05)


def test_the_seed_makes_the_noise():
    first, again, other = (tension.bar(configured("scene=tension", f"seed={s}")) for s in (0, 0, 1))
    assert np.array_equal(first.x, again.x)
    assert np.array_equal(first.y, again.y)
    assert not np.isclose(first.x, other.x, rtol=0, atol=1e-9).any()


def test_two_columns_at_either_end_move_as_the_exact_state_does():
    problem = tension.build(configured("scene=tension", "scene.strain=0.2"))
    body, held = problem.body, problem.constraints
    assert set(body.sites[0, held.x_index]) == {0, 1, 42, 43}
    assert held.x_index.size == 4 * 11
    np.testing.assert_allclose(held.x_target, 0.2 * body.x[held.x_index], rtol=1e-15)
    assert body.sites[:, held.y_index].T.tolist() == [[0, 5], [43, 5]]
    assert not held.y_target.any()
    assert [(s.action, s.until) for s in problem.stages] == [("load", None), ("settle", 12.0)]
    assert not problem.mirrors
    assert body.sites[1, problem.tracked] == 10


def test_the_middle_is_half_of_the_length_and_of_the_height():
    body = tension.bar(configured("scene=tension"))
    middle, section = body.tags["middle"], body.tags["section"]
    assert section.sum() == 22 * 11
    assert middle.sum() == 22 * 5
    assert np.abs(body.x[middle]).max() < 0.25
    assert np.abs(body.y[middle]).max() < 0.0625


@pytest.mark.parametrize(
    ("setting", "complaint"),
    [
        ("n=10", "must be odd"),
        ("scene.strain=0", "must not be zero"),
        ("scene.driven_columns=8", None),
        ("scene.length=0.1", "leaves 0 free columns"),
    ],
)
def test_resolution_and_strain_are_looked_at(setting, complaint):
    if complaint is None:
        assert configured("scene=tension", setting).scene.driven_columns == 8
        return
    with pytest.raises(ConfigurationError, match=complaint):
        configured("scene=tension", setting)


UNDAMPED = {"method": "thesis", "method.damping": 0.0}
"""Damping hardly matters to what clumps; without it the compiled code is that of the vibrating plate."""


@pytest.mark.slow
def test_at_one_percent_the_thesis_method_loses_the_stress_that_tl_keeps(tmp_path):
    settings = {"scene": "tension", "h": 1.5, "n": 7, "results": tmp_path}
    lost, kept = (sphstudy.run(**m, **settings) for m in (UNDAMPED, {"method": "tl"}))
    assert float(lost["stress_share"]) < 0.3
    assert float(lost["history_hourglass_amplitude"][-1]) > 0.02
    assert float(kept["stress_share"]) == pytest.approx(1.0, abs=0.05)
    assert float(kept["spacing_smallest"]) > 0.99


@pytest.mark.slow
def test_at_five_percent_the_thesis_method_tears_and_tl_holds_fifty(tmp_path):
    settings = {"scene": "tension", "h": 1.5, "n": 7, "scene.end_time": 6, "results": tmp_path}
    torn = sphstudy.run(**{"scene.strain": 0.05}, **UNDAMPED, **settings)
    whole = sphstudy.run(method="tl", **{"scene.strain": 0.5}, **settings)
    assert (float(torn["torn"]), float(whole["torn"])) == (1.0, 0.0)
    assert abs(float(torn["stress_share_section"])) < 0.2
    assert float(whole["stress_share"]) == pytest.approx(1.0, abs=0.05)
    assert float(whole["gap_largest"]) < 1.1
