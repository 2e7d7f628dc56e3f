"""The largest stable step is found where theory has it, and where there is none, that is what is said."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import sphstudy
from sphstudy.analysis.cost_forecast import prospect
from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.model.problem import Stage
from sphstudy.numerics.solvers import explicit, growth, limit
from sphstudy.store import record
from sphstudy.store.measured import measured
from sphstudy.store.record import STATUS

STAGE = Stage("free", "run", duration=1.0)


class Oscillators:
    """Independent oscillators as a System, by Verlet's or Heun's method, of frequencies [N] (rad/s).

    `friction` (1/s): damping, by Heun's method only.
    """

    def __init__(self, omega, dt, velocity=1e-5, heun=False, friction=0.0):
        self.square, self.dt, self.heun, self.friction = np.asarray(omega) ** 2, dt, heun, friction
        self.state = np.zeros((6, self.square.size))
        self.state[2:4] = velocity
        self.pairs = 1

    def begin(self, stage, amplitude_rate, kept):
        assert amplitude_rate == 0.0
        return ""

    def advance(self, begin, end):
        place, velocity = self.state[:2], self.state[2:4]
        for _ in range(begin, end):
            if self.heun:
                first = velocity.copy(), -self.square * place - self.friction * velocity
                x, v = place + self.dt * first[0], velocity + self.dt * first[1]
                second = v, -self.square * x - self.friction * v
                place += 0.5 * self.dt * (first[0] + second[0])
                velocity += 0.5 * self.dt * (first[1] + second[1])
            else:
                velocity -= 0.5 * self.dt * self.square * place
                place += self.dt * velocity
                velocity -= 0.5 * self.dt * self.square * place
            if not np.abs(self.state).max() < 1e100:
                return end, "a value that is not finite"
        return end, ""

    def totals(self):
        kinetic, strain = 0.5 * self.state[2:4] ** 2, 0.5 * self.square * self.state[:2] ** 2
        return SimpleNamespace(kinetic_energy=kinetic.sum(), strain_energy=strain.sum())


def bracket(lowest=0.2, highest=8.0, tolerance=0.005, **system):
    def trial(dt):
        return growth.shaken(Oscillators(dt=dt, **system), STAGE, 1000, 0)

    return growth.bisect(trial, lowest, highest, tolerance, lambda trials: None)


@pytest.mark.parametrize("omega", [[1.0], np.linspace(0.01, 1.7, 40)])
def test_verlet_is_stable_to_two_over_the_highest_frequency(omega):
    found = bracket(omega=omega)
    assert found.stable < 2.0 / np.max(omega) <= found.unstable <= 1.005 * found.stable
    assert found.trials >= 10


def test_heun_with_friction_is_stable_to_where_its_polynomial_says():
    # |1 + z + z²/2| = 1 for both z = λ Δt with λ² + γλ + ω² = 0.
    roots = np.roots([1.0, 0.5, 1.0])
    steps = np.linspace(0.2, 8.0, 20_000)
    z = roots[:, None] * steps
    edge = steps[np.argmax((np.abs(1.0 + z + 0.5 * z**2) > 1.0).any(axis=0))]
    found = bracket(omega=[1.0], heun=True, friction=0.5, tolerance=0.02)
    assert found.stable < 1.001 * edge
    assert found.unstable > 0.999 * edge


def test_undamped_heun_has_no_stable_step():
    found = bracket(omega=np.linspace(0.5, 1.0, 20), heun=True)
    assert np.isnan(found.stable)
    assert found.unstable == 0.2
    assert found.trials == 2


def test_a_limit_beyond_the_longest_step_is_said_to_lie_there():
    found = bracket(omega=[1.0], highest=1.9)
    assert found.stable == 1.9
    assert np.isnan(found.unstable)


def test_what_grows_fastest_comes_out_of_the_noise():
    omega = np.linspace(0.1, 1.0, 30)
    velocity = 1e-5 * np.random.default_rng(3).standard_normal((2, 30))
    shape = growth.fastest_growing(Oscillators(omega, 3.0, velocity), STAGE, 100)
    assert np.mean(shape**2) == pytest.approx(1.0)
    assert (shape[:, omega > 0.8] ** 2).sum() > 0.9 * (shape**2).sum()
    assert growth.fastest_growing(Oscillators(omega, 1.9, velocity), STAGE, 100) is None


def test_noise_leaves_alone_what_is_held():
    config = composed("method=tl")
    problem = scene_module("plate").build(config)
    velocity = growth.noise(problem, 0)
    held = problem.constraints.x_index
    assert held.size
    assert (velocity[:, held] == 0.0).all()
    assert np.abs(velocity[:, np.setdiff1d(np.arange(velocity.shape[1]), held)]).min() > 0.0
    assert (velocity == growth.noise(problem, 0)).all()
    assert (velocity != growth.noise(problem, 1)).any()


def composed(*settings):
    with session() as hydra:
        given = ["scene=plate", "solve=limit", "n=3", "h=1.3", "solve.steps=1000", *settings]
        return hydra.points(given, sweep=False)[0][0].config


def solved(config, **system):
    """A search among fake oscillators of frequency 1 in units of the step with C = 1."""
    problem = scene_module("plate").build(config)

    def fake(problem, config, dt, integrator):
        velocity = np.stack((problem.velocity_x, problem.velocity_y))
        omega = np.full(problem.body.x.size, unit)
        return Oscillators(omega, dt, velocity, heun=integrator == "heun", **system)

    method = SimpleNamespace(INTEGRATORS=("verlet", "heun"), wave_speed=lambda *_: 2.0, system=fake)
    unit = 2.0 / problem.step_spacing
    progress = []
    solution = limit.run(problem, config, method, lambda step, steps: progress.append((step, steps)))
    assert progress[-1][0] == progress[-1][1]
    assert [step for step, _ in progress] == sorted(step for step, _ in progress)
    return solution, problem


def test_the_limit_and_what_it_took_are_recorded():
    solution, problem = solved(composed("method=tl", "solve.tolerance=0.05"))
    found = {name: variable.values for name, variable in solution.variables.items()}
    assert solution.outcome == "done"
    assert solution.message == ""
    assert found["largest_stable_courant"] == pytest.approx(2.0, rel=0.05)
    unit = problem.step_spacing / 2.0
    assert found["largest_stable_step"] == pytest.approx(found["largest_stable_courant"] * unit)
    assert 0.0 < found["bracket_width"] <= 0.05
    assert found["trials"] == 8.0
    assert np.isnan(found["predicted_step"])
    assert np.isnan(found["predicted_ratio"])
    assert solution.steps > 1000


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (["solve.integrator=heun"], "no stable step found down to C = 0.2"),
        (["solve.highest_courant=1.5"], "stable up to C = 1.5, the longest step tried"),
    ],
)
def test_no_limit_between_the_bounds_is_a_result_that_says_so(settings, message):
    config = composed("method=tl", *settings)
    solution, problem = solved(config)
    assert solution.outcome == "done"
    assert solution.message == message
    assert np.isnan(solution.variables["largest_stable_courant"].values)
    run = record.with_outcome(
        record.fields(problem, solution), solution.outcome, solution.message, {}, {"title": ""}
    )
    # Nothing moved that the scene could measure, and its metrics have no say in the message.
    again = measured(run, config)
    assert again.attrs["message"] == message
    assert not [name for name, v in again.items() if v.attrs.get("group") == "metric"]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (("method=thesis", "solve.integrator=verlet"), "method thesis takes heun"),
        (("method=tl", "solve.lowest_courant=5"), "should be below solve.highest_courant=4"),
        (("method=tl", "record.times=[1.0]"), "knows no time"),
    ],
)
def test_wrong_settings_are_named(settings, said):
    work, complaints = prospect(composed(*settings))
    assert work.steps == 0.0
    assert any(said in complaint for complaint in complaints)


def test_its_cost_is_foreseen():
    work, complaints = prospect(composed("method=thesis"))
    assert not complaints
    assert work.steps == 1000 * 6


def test_no_threads():
    with pytest.raises(ConfigurationError, match="one thread"):
        composed("method=tl", "threads=2")


def test_a_scene_that_starts_in_motion_is_searched_at_rest():
    config = composed("method=tl", "solve.highest_courant=1.5")
    problem = scene_module("plate").build(config)
    seen = []

    def fake(start, config, dt, integrator):
        seen.append(start)
        return Oscillators(np.full(start.body.x.size, 2.0 / start.step_spacing), dt)

    method = SimpleNamespace(INTEGRATORS=("verlet",), wave_speed=lambda *_: 2.0, system=fake)
    moved = replace(problem, displacement_x=np.ones(problem.body.x.size))
    limit.run(moved, config, method, lambda *_: None)
    for start in seen:
        assert (start.start == np.stack((problem.body.x, problem.body.y))).all()
        speed = np.sqrt(np.mean(start.velocity_x**2 + start.velocity_y**2))
        assert speed < 1e-4 * problem.body.material.wave_speed


@pytest.mark.slow
@pytest.mark.parametrize("nu", [0.3, 0.49])
def test_verlet_on_the_plate_is_stable_to_the_prediction(nu, tmp_path):
    run = sphstudy.run(
        scene="plate", method="tl", solve="limit", h=1.3, n=5, results=tmp_path, **{"scene.nu": nu}
    )
    assert STATUS[int(run["status"])] == "done"
    # From below, by no more than the bracket; power iteration estimates ω_max from below.
    assert 0.99 < float(run["predicted_ratio"]) < 1.002


@pytest.mark.slow
def test_the_vibrating_plate_of_the_thesis_breaks_where_its_limit_is():
    thesis = ["scene=plate", "method=thesis", "h=1.3", "n=5"]
    with session() as hydra:

        def config(*settings):
            return hydra.points([*thesis, *settings], sweep=False)[0][0].config

        searched = config("solve=limit", "solve.tolerance=0.02")
        problem, method = scene_module("plate").build(searched), method_module(searched.method.kind)
        found = limit.run(problem, searched, method, lambda *_: None)
        courant = float(found.variables["largest_stable_courant"].values)
        for factor, outcome in ((0.95, "done"), (1.15, "diverged")):
            stepped = config(f"solve.courant={factor * courant}")
            assert explicit.run(problem, stepped, method, lambda *_: None).outcome == outcome
