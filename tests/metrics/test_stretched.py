"""Clumped, open and torn: synthetic states of a bar and a disc with known answers."""

import numpy as np
import pytest

from sphstudy.metrics import equibiaxial_stress, stretched, uniaxial_stress
from sphstudy.model.exact import homogeneous
from sphstudy.model.scenes import radial, tension
from sphstudy.numerics.solvers.solution import Snapshot, Solution
from sphstudy.store.record import fields
from tests.model.scenes.test_tension import configured


def held(scene, *settings):
    """Record of a body in its exact state, loaded and held."""
    config = configured(f"scene={scene}", "scene.strain=0.2", *settings)
    problem = (tension if scene == "tension" else radial).build(config)
    body = problem.body
    law, along = stretched.law_of(config), 1.2
    across, transverse = along, 0.0
    if scene == "tension":
        stress = homogeneous.uniaxial_stress(law, body.material, 0.2)
        across = homogeneous.lateral_stretch(law, body.material, 0.2)
    else:
        stress = transverse = homogeneous.equibiaxial_stress(law, body.material, 0.2)
    state = np.zeros((8, body.x.size))
    state[0], state[1], state[5], state[6] = along * body.x, across * body.y, stress, transverse
    snapshots = [Snapshot(label, 0.0, 0, state.copy(), 0.0) for label in ("load", "settle")]
    return fields(problem, Solution(snapshots=snapshots)), config


def values(run, config):
    stress = uniaxial_stress if config.scene.kind == "tension" else equibiaxial_stress
    found = stretched.measure(run, config) | stress.measure(run, config)
    return {name: metric.value for name, metric in found.items()}


@pytest.mark.parametrize("method", ["tl", "thesis"])
@pytest.mark.parametrize("scene", ["tension", "radial"])
def test_the_exact_state_is_sound(scene, method):
    found = values(*held(scene, f"method={method}"))
    for name in ("stress_share_load", "stress_share"):
        assert found[name] == pytest.approx(1.0, rel=1e-12)
    assert found["stress_spread"] == pytest.approx(0.0, abs=1e-12)
    assert found["spacing_smallest"] == pytest.approx(1.0, abs=5e-3)
    assert found["spacing_spread"] < 2e-3
    assert found["gap_largest"] == pytest.approx(1.0, abs=5e-3)
    assert found["gaps_open"] == found["torn"] == 0.0


def test_particles_in_pairs_are_close_with_gaps_between_but_not_torn():
    """Every other column moved back by 0.4 spacings: 0.6 and 1.4 in turns."""
    run, config = held("tension", "method=tl", "scene.noise=0")
    column = np.arange(44 * 11) % 44
    run["x"].values[1] -= 0.4 * 1.2 * float(run["spacing_x"]) * (column % 2)
    found = values(run, config)
    across = homogeneous.lateral_stretch("neohookean", tension.bar(config).material, 0.2)
    assert found["spacing_smallest"] == pytest.approx(0.6 * 1.2 / across)
    assert found["spacing_spread"] == pytest.approx(0.0, abs=1e-9)
    assert found["gap_largest"] == pytest.approx(1.4)
    assert (found["gaps_open"], found["torn"]) == (0.0, 0.0)


def test_driven_particles_do_not_count_as_clumped():
    run, config = held("tension", "method=tl", "scene.noise=0")
    run["x"].values[1, 0] += 0.5 * float(run["spacing_x"])
    assert values(run, config)["spacing_smallest"] == pytest.approx(1.0)
    run["x"].values[1, 22] += 0.5 * float(run["spacing_x"])
    assert values(run, config)["spacing_smallest"] < 0.9


def test_a_gap_through_part_of_the_height_is_open_one_through_all_of_it_torn():
    for rows in (10, 11):
        run, config = held("tension", "method=tl", "scene.noise=0")
        beyond = (np.arange(44 * 11) % 44 >= 30) & (np.arange(44 * 11) // 44 < rows)
        # Across, the free row stays: it is the gap along x that opens, by 0.55 spacings.
        run["x"].values[1, beyond] += 0.55 * 1.2 * float(run["spacing_x"])
        found = values(run, config)
        assert found["gap_largest"] == pytest.approx(1.55)
        assert found["gaps_open"] == pytest.approx(rows / (43 * 11 + 44 * 10))
        assert found["torn"] == (rows == 11)


def test_a_particle_that_has_left_the_disc_is_a_piece():
    run, config = held("radial", "method=tl")
    run["x"].values[1, int(np.argmin(np.hypot(run["reference_x"], run["reference_y"]).values))] += 3.0
    assert values(run, config)["torn"] == 1.0


def test_only_the_middle_and_the_named_moment_tell_the_share():
    run, config = held("tension", "method=thesis")
    middle, section = run["tag_middle"].values == 1, run["tag_section"].values == 1
    run["stress_xx"].values[1, middle] *= 0.25
    found = values(run, config)
    assert found["stress_share_load"] == pytest.approx(1.0)
    assert found["stress_share"] == pytest.approx(0.25)
    share = middle.sum() / section.sum()
    assert found["stress_share_section"] == pytest.approx(0.25 * share + 1.0 - share)
    run["stress_xx"].values[1] = 7.0 * run["stress_xx"].values[0]
    run["stress_xx"].values[1, middle] *= np.where(np.arange(middle.sum()) % 2, 1.1, 0.9) / 7.0
    assert values(run, config)["stress_spread"] == pytest.approx(0.1)


def test_of_a_disc_the_mean_of_both_normal_stresses_counts():
    run, config = held("radial", "method=tl")
    run["stress_xx"].values[1] *= 0.5
    assert values(run, config)["stress_share"] == pytest.approx(0.75)
    run["stress_yy"].values[1] *= 1.5
    assert values(run, config)["stress_share"] == pytest.approx(1.0)


def test_lattice_neighbours_of_three_by_two():
    x, y = np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0]), np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    pairs, along = stretched.lattice_pairs(x, y, 1.0)
    found = {tuple(sorted(p)): a for p, a in zip(pairs.T.tolist(), along, strict=True)}
    assert found == {(0, 1): True, (1, 2): True, (3, 4): True, (4, 5): True,
                     (0, 3): False, (1, 4): False, (2, 5): False}  # fmt: skip
    assert stretched.pieces(pairs[:, along], 6) == 2
    assert stretched.pieces(pairs, 6) == 1
