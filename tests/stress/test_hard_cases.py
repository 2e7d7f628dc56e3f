"""Reduced hard cases: what must come out the same however a run is made, and colliding rings."""

import numpy as np
import pytest

import sphstudy
from sphstudy.numerics.solvers.checkpoint import NoKeeper
from sphstudy.numerics.solvers.solution import HISTORY
from tests.numerics.solvers.test_checkpoint import Stop, Switch, solved

pytestmark = pytest.mark.slow

RINGS = [
    "scene=rings", "method=tl", "h=1.3", "n=4", "scene.duration=6", "scene.speed=0.12", "scene.gap=4",
    "record.samples=12", "record.frames=4",
]  # fmt: skip


def test_contact_is_the_same_after_a_restart_to_the_last_bit():
    expected = solved(RINGS, NoKeeper())
    energy = np.array(expected.history)[:, HISTORY.index("kinetic_energy")]
    assert energy.min() < 0.7 * energy[0], "they should have met"
    for countdown in (5, 9):
        switch = Switch(countdown)
        with pytest.raises(Stop):
            solved(RINGS, switch)
        again = solved(RINGS, Switch(10**9, switch.kept))
        np.testing.assert_array_equal(np.array(again.history), np.array(expected.history))
        for one, other in zip(again.snapshots, expected.snapshots, strict=True):
            np.testing.assert_array_equal(one.fields, other.fields)


def test_rings_of_the_total_lagrangian_method_rebound_whole(tmp_path):
    run = sphstudy.run(scene="rings", method="tl", h=1.3, n=4, results=tmp_path)
    assert float(run["broken_bonds"]) == 0
    assert float(run["momentum_drift"]) < 1e-13
    assert float(run["energy_drift"]) < 1e-4
    assert float(run["mirror_defect"]) < 1e-6
    assert 0.6 < float(run["rebound"]) < 1.0


def test_rings_of_the_thesis_break_in_collision(tmp_path):
    run = sphstudy.run(scene="rings", method="thesis", h=1.5, n=4, results=tmp_path)
    assert float(run["broken_bonds"]) > 10
    assert float(run["rebound"]) < 0.5
