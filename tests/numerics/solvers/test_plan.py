"""Stages become steps: the protocol's numbers, a loading time, an end time."""

import dataclasses

import pytest

from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import session
from sphstudy.numerics.solvers import explicit


def planned(*overrides):
    with session() as hydra:
        config = hydra.points(list(overrides), sweep=False)[0][0].config
    problem = scene_module(config.scene.kind).build(config)
    method = method_module(config.method.kind)
    dt = explicit.time_step(problem, config, method)
    return explicit.plan(problem.stages, config.solve, dt), dt


def test_crack_holds_the_number_of_loading_steps():
    assert planned("n=40")[0] == planned("n=60")[0] == [8467, 4000, 3500, 3500]


def test_crack_can_hold_the_loading_time_instead():
    steps, dt = planned("n=40", "solve.load_time=0.1")
    assert steps[0] * dt == pytest.approx(0.1, abs=dt)
    assert planned("n=60", "solve.load_time=0.1")[0][0] == 8467


def test_bending_ends_at_its_end_time():
    steps, dt = planned("scene=bending", "n=9")
    assert steps[0] == 4840
    assert sum(steps) * dt == pytest.approx(11.0, abs=dt)


def test_plate_runs_one_period():
    steps, dt = planned("scene=plate", "n=21")
    assert steps[0] * dt == pytest.approx(6.5396, abs=1e-3)


def test_time_step_from_the_highest_frequency():
    settings = ("scene=plate", "method=tl", "n=5", "h=1.3", "solve.time_step=frequency")
    with session() as hydra:
        config = hydra.points(list(settings), sweep=False)[0][0].config
    omega = method_module(config.method.kind).highest_frequency(
        scene_module(config.scene.kind).build(config), config
    )
    assert planned(*settings, "solve.safety=0.5")[1] == pytest.approx(0.5 * 2.0 / omega, rel=1e-12)
    # The rule at C = 1 lies a little below the limit of stability.
    by_rule = planned(*settings[:-1], "solve.courant=1")[1]
    assert 1.0 < 2.0 / omega / by_rule < 1.1


def test_parameters_are_frozen():
    with session() as hydra:
        config = hydra.points([], sweep=False)[0][0].config
    with pytest.raises(dataclasses.FrozenInstanceError):
        config.h = 2.0
