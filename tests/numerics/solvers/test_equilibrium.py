"""Equilibria: against dense algebra, against stepping, at finite strain, and where there is none."""

import dataclasses

import numpy as np
import pytest

from sphstudy.analysis.cost_forecast import prospect
from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.numerics.solvers import equilibrium, explicit
from sphstudy.numerics.solvers.newton import Effort, Newton
from sphstudy.numerics.solvers.potential_system import internal_force
from sphstudy.numerics.sph import stiffness, total_lagrangian


def configured(*settings):
    with session() as hydra:
        return hydra.points(["method=tl", *settings], sweep=False)[0][0].config


def solved(*settings):
    config = configured("solve=equilibrium", *settings)
    problem = scene_module(config.scene.kind).build(config)
    method = method_module(config.method.kind)
    return equilibrium.run(problem, config, method, lambda *_: None), problem, config


def energies(solution):
    return np.array([snapshot.strain_energy for snapshot in solution.snapshots])


def test_linear_equilibrium_is_that_of_dense_algebra():
    solution, problem, config = solved("scene=mode1", "n=16", "h=1.3")
    model = method_module(config.method.kind).model(problem, config, problem.stages[0].crack_nodes)
    unit = np.tile([[1.0], [0.0], [0.0], [1.0]], model.x.size)
    dense = stiffness.tangent(model, stiffness.operators(model), unit).toarray()
    held = np.concatenate((model.constraints.x_index, model.x.size + model.constraints.y_index))
    free = np.setdiff1d(np.arange(2 * model.x.size), held)
    u = np.zeros(2 * model.x.size)
    u[held] = np.concatenate((model.constraints.x_target, model.constraints.y_target))
    u[free] = np.linalg.solve(dense[np.ix_(free, free)], -dense[np.ix_(free, held)] @ u[held])
    found = solution.snapshots[0].fields[:2].ravel() - np.concatenate((model.x, model.y))
    np.testing.assert_allclose(found, u, atol=1e-12 * np.abs(u).max())
    assert solution.snapshots[0].strain_energy == pytest.approx(0.5 * u @ dense @ u, rel=1e-11)


@pytest.mark.parametrize("share", [1e-3, 1e-5])
def test_a_small_load_has_its_equilibrium(share):
    """A linear problem: the energy goes with the square of the load, as far as positions have digits."""
    full = solved("scene=bending", "n=9", "h=1.3")[0]
    small = solved("scene=bending", "n=9", "h=1.3", f"scene.deflection={-0.04 * share}")[0]
    assert small.outcome == "done"
    assert small.steps <= 2 * full.steps
    assert energies(small)[-1] == pytest.approx(share**2 * energies(full)[-1], rel=1e-10 / share)


def test_a_load_that_rounding_drowns_has_none():
    solution, _, _ = solved("scene=bending", "n=9", "h=1.3", "scene.deflection=-4e-12")
    assert solution.outcome == "diverged"
    assert "rounding of positions" in solution.message


@pytest.mark.parametrize("law", ["linear", "svk", "neohookean"])
@pytest.mark.parametrize("scene", ["mode1", "bending"])
def test_free_particles_are_at_rest_and_prescribed_ones_in_place(scene, law):
    solution, problem, config = solved(f"scene={scene}", "n=16" if scene == "mode1" else "n=5", "h=1.3",
                                       f"method.law={law}")  # fmt: skip
    assert solution.outcome == "done"
    for stage, snapshot in zip(problem.stages, solution.snapshots, strict=True):
        model = method_module(config.method.kind).model(problem, config, stage.crack_nodes)
        force = internal_force(model, *snapshot.fields[:2])
        size = np.linalg.norm(force)
        constraints = model.constraints
        place = snapshot.fields[:2] - np.stack((model.x, model.y))
        np.testing.assert_allclose(place[0, constraints.x_index], constraints.x_target, atol=1e-15)
        np.testing.assert_allclose(place[1, constraints.y_index], constraints.y_target, atol=1e-15)
        force[0, constraints.x_index] = force[1, constraints.y_index] = 0.0
        assert np.linalg.norm(force) < 1.1e-9 * size


def test_no_neighbouring_state_has_less_energy(rng):
    solution, problem, config = solved("scene=mode2", "n=16", "h=1.5", "method.law=neohookean")
    model = method_module(config.method.kind).model(problem, config, problem.stages[0].crack_nodes)
    free = np.ones((2, model.x.size))
    free[0, model.constraints.x_index] = free[1, model.constraints.y_index] = 0.0
    work, place = total_lagrangian.workspace(model.x.size), solution.snapshots[0].fields[:2]
    least = sum(total_lagrangian.energies(model, *place, work))
    for _ in range(10):
        moved = place + 1e-5 * free * rng.normal(size=place.shape)
        assert sum(total_lagrangian.energies(model, *moved, work)) > least


def test_work_of_closure_is_the_energy_released():
    solution = solved("scene=mode2", "n=16", "h=1.3")[0]
    released = -np.diff(energies(solution))[1:]
    closures = [snapshot.closure_work for snapshot in solution.snapshots]
    assert np.isnan(closures[:2]).all()
    np.testing.assert_allclose(closures[2:], released, rtol=1e-9)


def test_damped_stepping_ends_there_and_closes_the_crack_with_the_same_work():
    settings = ("scene=mode1", "n=16", "h=1.3")
    statics, problem, _ = solved(*settings)
    config = configured("solve=explicit", *settings)
    stepped = explicit.run(problem, config, method_module(config.method.kind), lambda *_: None)
    np.testing.assert_allclose(energies(stepped)[1:], energies(statics)[1:], rtol=1e-6)
    closures = [[s.closure_work for s in run.snapshots[2:]] for run in (stepped, statics)]
    np.testing.assert_allclose(*closures, rtol=1e-5)


def test_finite_strain_tends_to_the_linear_law_with_the_load():
    """Strain enters the energies in third order: a tenth of the load, a tenth of the difference."""
    differences = []
    for load in (3.58e3, 3.58e2):
        linear, finite = (
            energies(solved("scene=mode1", "n=16", f"scene.K={load}", f"method.law={law}")[0])
            for law in ("linear", "svk")
        )
        differences.append(np.abs(finite / linear - 1.0).max())
    assert differences[0] == pytest.approx(10.0 * differences[1], rel=0.05)


def test_increments_do_not_matter():
    one, several = (
        energies(solved("scene=mode1", "n=16", "method.law=svk", f"solve.increments={k}")[0])
        for k in (1, 4)
    )
    np.testing.assert_allclose(several, one, rtol=1e-9)


def test_inversion_ends_the_run_with_its_reason():
    solution = solved("scene=mode2", "n=20", "h=1.3", "method.law=svk", "scene.K=6e5")[0]
    assert solution.outcome == "diverged"
    assert "det F ≤ 0" in solution.message
    assert "stage load" in solution.message


def test_too_few_iterations_are_said():
    solution = solved(
        "scene=mode1", "n=16", "method.law=svk", "solve.iterations=1", "solve.tolerance=1e-12"
    )[0]
    assert solution.outcome == "diverged"
    assert "iteration 1 leaves a residual" in solution.message


def test_buckling_is_an_unstable_state_not_an_answer():
    """A slender plate pressed along its axis: beyond Euler's load the straight state is no minimum."""
    config = configured("scene=bending", "n=5", "h=1.3", "solve=equilibrium", "method.law=neohookean")
    problem = scene_module("bending").build(config)
    end = np.flatnonzero(problem.body.tags["end"])
    clamped = np.flatnonzero(problem.body.tags["clamped"])
    index = np.concatenate((clamped, end))
    target = np.concatenate((np.zeros(clamped.size), np.full(end.size, -0.05)))
    constraints = problem.constraints._replace(
        x_index=index, x_target=target, y_index=clamped, y_target=np.zeros(clamped.size)
    )
    pressed = dataclasses.replace(problem, constraints=constraints)
    method = method_module(config.method.kind)
    solution = equilibrium.run(pressed, config, method, lambda *_: None)
    assert solution.outcome == "diverged"
    assert "not positive definite" in solution.message
    # Half of Euler's strain, π² D²/48 L² for this clamped-free column, is borne.
    newton = Newton(method.model(pressed, config, 0), 1e-9, 30, Effort())
    borne = newton.equilibrium(np.concatenate((problem.body.x, problem.body.y)), 0.5 * 0.00143 / 0.05)
    assert np.isfinite(borne).all()


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (["scene=plate", "solve=equilibrium"], "stage vibrate of scene plate moves freely"),
        (["scene=mode1", "solve=modes"], "it does not vibrate"),
        (["scene=plate", "solve=modes", "solve.count=1000", "n=3", "h=1.3"], "that can be found"),
        (["scene=mode1", "solve=equilibrium", "record.times=[1.0]"], "knows no time"),
        (["scene=mode1", "solve=equilibrium", "record.frames=3"], "record.frames=3: solve=equilibrium"),
        (["scene=mode1", "method=thesis", "solve.time_step=frequency"], "take courant"),
        (["scene=mode1", "method=thesis", "solve.integrator=verlet"], "method thesis takes heun"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(settings, said):
    method = [] if any(s.startswith("method=") for s in settings) else ["method=tl"]
    with session() as hydra:
        (point,), _ = hydra.points([*method, *settings], sweep=False)
    complaints = prospect(point.config)[1]
    assert any(said in complaint for complaint in complaints)


@pytest.mark.parametrize("solve", ["explicit", "equilibrium", "limit"])
def test_a_method_without_smoothed_velocity_smears_none(solve):
    refused = pytest.raises(ConfigurationError, match=r"method\.smoothing")
    with session() as hydra, refused:
        hydra.points(["method=tl", f"solve={solve}", "method.smoothing=0.5"], sweep=False)


def test_the_thesis_has_no_potential_to_solve():
    with session() as hydra, pytest.raises(ConfigurationError, match="method thesis takes explicit"):
        hydra.points(["scene=mode1", "method=thesis", "solve=equilibrium"], sweep=False)
