"""The pulled disc: what it is cut from, what drives it, and what becomes of it."""

import numpy as np
import pytest

import sphstudy
from sphstudy.errors import ConfigurationError
from sphstudy.model.scenes import radial
from tests.model.scenes.test_tension import UNDAMPED, configured


def test_the_disc_is_cut_from_a_symmetric_lattice():
    config = configured("scene=radial", "scene.noise=0")
    body = radial.build(config).body
    assert body.x.size == radial.particles(config)
    assert body.mass.sum() == pytest.approx(7750.0 * np.pi * 0.25, rel=0.01)
    assert np.hypot(body.x, body.y).max() < 0.5
    places = {tuple(p) for p in np.round(np.stack((body.x, body.y)).T / body.spacing_x, 6)}
    assert {(-x, y) for x, y in places} == places == {(y, x) for x, y in places}
    np.testing.assert_allclose(body.x / body.spacing_x, body.sites[0] - 19.5, atol=1e-9)
    np.testing.assert_allclose(body.y / body.spacing_y, body.sites[1] - 19.5, atol=1e-9)


def test_the_rim_moves_outwards_in_proportion_to_its_distance():
    problem = radial.build(configured("scene=radial"))
    body, held = problem.body, problem.constraints
    distance = np.hypot(body.x, body.y) / body.spacing_x
    rim = np.isin(np.arange(body.x.size), held.x_index)
    assert np.array_equal(held.x_index, held.y_index)
    assert distance[rim].min() > 13.99
    assert distance[~rim].max() < 14.01
    np.testing.assert_allclose(
        np.hypot(held.x_target, held.y_target), 0.05 * np.hypot(body.x, body.y)[rim]
    )
    np.testing.assert_allclose(held.x_target, 0.05 * body.x[rim])
    assert not rim[problem.tracked]
    assert distance[body.tags["middle"]].max() < 10.01
    assert not (rim & body.tags["middle"]).any()


def test_a_disc_without_a_middle_is_refused():
    with pytest.raises(ConfigurationError, match="must be at least 28"):
        configured("scene=radial", "n=27")
    with pytest.raises(ConfigurationError, match="must not be zero"):
        configured("scene=radial", "scene.strain=0")


@pytest.mark.slow
def test_tension_without_shear_is_enough_for_the_thesis_method_to_clump(tmp_path):
    settings = {"scene": "radial", "h": 1.5, "n": 24, "scene.rim_layers": 5, "scene.end_time": 6}
    methods = (UNDAMPED, {"method": "tl"})
    clumped, kept = (sphstudy.run(**m, **settings, results=tmp_path) for m in methods)
    assert float(clumped["stress_share"]) < 0.3
    assert float(clumped["spacing_smallest"]) < 0.5
    assert float(kept["stress_share"]) == pytest.approx(1.0, abs=0.01)
    assert float(kept["spacing_smallest"]) > 0.99
