"""The patch: how its particles are disturbed, what its frame does, and how well the inside follows."""

import numpy as np
import pytest

import sphstudy
from sphstudy.errors import ConfigurationError
from sphstudy.model.scenes import patch
from tests.model.scenes.test_tension import UNDAMPED, configured


def test_all_particles_are_off_the_lattice_by_at_most_the_perturbation():
    config = configured("scene=patch", "scene.perturbation=0.3")
    body = patch.build(config).body
    assert body.x.size == patch.particles(config) == 900
    off = np.abs(np.stack((body.x, body.y)) / body.spacing_x - (body.sites - 14.5))
    assert 0.29 < off.max() <= 0.3
    assert off[:, body.tags["frame"]].min() > 0.0
    assert off.mean() == pytest.approx(0.15, rel=0.05)
    assert np.ptp(body.mass) == 0.0
    assert body.mass.sum() == pytest.approx(7750.0)


def test_the_frame_moves_by_the_affine_displacement():
    problem = patch.build(configured("scene=patch", "scene.gradient_xy=0.01", "scene.gradient_yx=0"))
    body, held = problem.body, problem.constraints
    outer = (np.minimum(body.sites, 29 - body.sites) < 2).any(axis=0)
    assert np.array_equal(held.x_index, np.flatnonzero(outer))
    assert np.array_equal(held.y_index, held.x_index)
    x, y = body.x[outer], body.y[outer]
    np.testing.assert_allclose(held.x_target, 1e-3 * x + 0.01 * y, rtol=1e-12)
    np.testing.assert_allclose(held.y_target, -4e-4 * y, rtol=1e-12)
    assert not outer[problem.tracked]


def test_a_patch_needs_an_inside_and_a_motion():
    with pytest.raises(ConfigurationError, match="must be at least 6"):
        configured("scene=patch", "n=5")
    still = [f"scene.gradient_{c}=0" for c in ("xx", "xy", "yx", "yy")]
    with pytest.raises(ConfigurationError, match="needs a frame that moves"):
        configured("scene=patch", *still)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("perturbation", "layers", "least", "most"), [(0, 4, 0, 1e-12), (0.25, 2, 5e-3, 0.08)]
)
def test_tl_is_exact_on_a_lattice_and_no_worse_than_the_spacing_off_it(
    tmp_path, perturbation, layers, least, most
):
    """Fourteen particles along a side: twice the spacing of the scene, hence about twice its error."""
    settings = {"scene.perturbation": perturbation, "scene.frame_layers": layers, "n": 14, "h": 1.3}
    run = sphstudy.run(scene="patch", method="tl", solve="equilibrium", results=tmp_path, **settings)
    assert least <= float(run["displacement_error"]) < most


@pytest.mark.slow
def test_stepped_and_solved_tl_agree_and_the_thesis_method_does_not_follow_the_frame(tmp_path):
    settings = {"scene": "patch", "n": 14, "h": 1.3, "results": tmp_path}
    solved = sphstudy.run(method="tl", solve="equilibrium", **settings)
    stepped = sphstudy.run(method="tl", **settings)
    thesis = sphstudy.run(**UNDAMPED, **settings)
    for name in ("displacement_error", "strain_error_rms"):
        assert float(stepped[name]) == pytest.approx(float(solved[name]), rel=1e-6)
    assert float(thesis["displacement_error"]) > 0.2
