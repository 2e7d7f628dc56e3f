"""Total Lagrangian models as a System, and what every solver needs to know of their states."""

from collections.abc import Callable

import numpy as np

from sphstudy.model.problem import Problem, Stage
from sphstudy.numerics.solvers import verlet
from sphstudy.numerics.sph import bonds, constitutive, total_lagrangian, viscosity
from sphstudy.numerics.sph.invariants import Invariants
from sphstudy.numerics.sph.total_lagrangian import Model, Workspace

POWER_ITERATIONS = 400
"""At most; the quotient has then long settled to more digits than a safety factor needs."""


class PotentialSystem:
    """A problem whose model is an energy (sph.total_lagrangian), stepped by Verlet's or Heun's method.

    dt (s); `model`: from the number of open crack nodes to the model; threads: how many sum over bonds.
    """

    def __init__(
        self,
        problem: Problem,
        dt: float,
        model: Callable[[int], Model],
        integrator: str,
        threads: int = 1,
    ):
        self.problem, self.dt, self._model_of = problem, dt, model
        self.model = model(problem.stages[0].crack_nodes)
        self._heun = True if integrator == "heun" else None
        body = problem.body
        self.state = np.zeros((verlet.STATE_ROWS, body.x.size))
        self.state[: verlet.Y + 1] = problem.start
        self.state[verlet.VX], self.state[verlet.VY] = problem.velocity_x, problem.velocity_y
        self.pairs = 0
        self._buffers = verlet.buffers(body.x.size, threads)
        self._released: np.ndarray | None = None

    def begin(self, stage: Stage, amplitude_rate: float, kept: dict[str, np.ndarray] | None) -> str:
        """See System."""
        before = self.model
        self.model, self.amplitude_rate = self._model_of(stage.crack_nodes), amplitude_rate
        self.pairs = max(self.pairs, self.model.bonds.total)
        self._renew_contact()
        x, y = self.state[verlet.X], self.state[verlet.Y]
        force = internal_force(self.model, x, y, self._buffers.work)
        if kept is not None:
            self._released = kept.get("released")
            return ""
        self._released = force - internal_force(before, x, y) if stage.extension else None
        verlet.accelerate(self.model, self.state, self._buffers)
        return ""

    def advance(self, begin: int, end: int) -> tuple[int, str]:
        """See System."""
        step, found = begin, verlet.OUTDATED
        while found == verlet.OUTDATED:
            step, found = verlet.advance(
                self._heun, self.model, self.state, self._buffers, self.amplitude_rate, self.dt, step, end
            )
            if found == verlet.OUTDATED:
                self._renew_contact()
        wrong = {
            verlet.SOUND: "",
            verlet.NOT_FINITE: "a value that is not finite",
            verlet.INVERTED: "an inverted deformation gradient, det F ≤ 0",
            verlet.TOO_FAR: "a step too far",
            verlet.TOO_FAST: "a particle faster than sound",
        }
        return step, wrong[found]

    def _renew_contact(self) -> None:
        surfaces = self.model.surfaces
        if surfaces is not None:
            contact = surfaces.contact(self.state[verlet.X], self.state[verlet.Y])
            self.model = self.model._replace(contact=contact)

    def totals(self) -> Invariants:
        """See System. The strain energy is all of the potential, hourglass and contact included."""
        return totals(self.model, self.state[:2], self.state[2:4], self.amplitude_rate)

    def fields(self) -> np.ndarray:
        """See System."""
        return fields(self.model, self.state[:2], self.state[2:4])

    def closure_work(self) -> float:
        """See solution.Snapshot."""
        return closure_work(self.model, self._released, self.state[:2])

    def memory(self) -> dict[str, np.ndarray]:
        """See System."""
        return {} if self._released is None else {"released": self._released}


def internal_force(
    model: Model, x: np.ndarray, y: np.ndarray, work: Workspace | None = None
) -> np.ndarray:
    """-∂U/∂x [2, N] (N/m) at the positions x, y [N] (m)."""
    force = np.zeros((2, x.size))
    total_lagrangian.force(model, x, y, work or total_lagrangian.workspace(x.size), force)
    return force


def closure_work(model: Model, released: np.ndarray | None, position: np.ndarray) -> float:
    """½ Σ `released` · (displacements now) [J/m]: the work that closes the crack again (Irwin 1957;
    Rybicki & Kanninen 1977), exactly the energy released if all is linear.

    `released` [2, N]: change of the forces (N/m) when bonds were cut: what held the crack closed is gone.
    """
    if released is None:
        return np.nan
    return 0.5 * float(np.sum(released * (position - np.stack((model.x, model.y)))))


def totals(model: Model, position: np.ndarray, velocity: np.ndarray, amplitude_rate: float) -> Invariants:
    """Invariants of a state: positions and velocities [2, N] (m, m/s)."""
    mass, work = model.mass, total_lagrangian.workspace(model.mass.size)
    force = internal_force(model, position[0], position[1], work)
    viscosity.add_forces(model.viscosity, model, *velocity, *position, force)
    energy = sum(total_lagrangian.energies(model, *position, work))
    squared = (velocity**2).sum(axis=0)
    momentum = (mass * velocity).sum(axis=1)
    spin = float((mass * (position[0] * velocity[1] - position[1] * velocity[0])).sum())
    constraints = model.constraints
    power = -amplitude_rate * (
        force[0, constraints.x_index] @ constraints.x_target
        + force[1, constraints.y_index] @ constraints.y_target
    )
    first, second = bonds.as_pairs(model.bonds)[:2]
    distance = np.hypot(*(position[:, second] - position[:, first]))
    magnitude = float(np.hypot(*force).sum())
    return Invariants(
        system_speed=float(np.sqrt(squared.sum())),
        momentum_x=float(momentum[0]),
        momentum_y=float(momentum[1]),
        angular_momentum=spin,
        kinetic_energy=0.5 * float(mass @ squared),
        strain_energy=energy,
        largest_speed=float(np.sqrt(squared.max())),
        smallest_spacing=float(distance.min()),
        net_internal_force=float(np.hypot(*force.sum(axis=1))) / magnitude if magnitude else 0.0,
        constraint_power=float(power),
    )


def fields(model: Model, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """The body as a record keeps it [8, N], rows solution.FIELDS: density ρ0/J and Cauchy's stress.

    Under the linear law, which knows no difference between configurations, ρ0 and the stress itself.
    """
    work = total_lagrangian.workspace(model.mass.size)
    total_lagrangian.deformation_gradient(None, model, *position, work.gradient)
    xx, xy, yx, yy = work.gradient
    stress = constitutive.stresses(model.law, work.gradient)
    density = model.mass / model.volume
    if model.law.objective:
        area = xx * yy - xy * yx
        density = density / area
        p_xx, p_xy, p_yx, p_yy = stress
        cauchy = (p_xx * xx + p_xy * xy, p_yx * yx + p_yy * yy, p_xx * yx + p_xy * yy)
        stress_xx, stress_yy, stress_xy = (component / area for component in cauchy)
    else:
        stress_xx, stress_xy, _, stress_yy = stress
    return np.stack((*position, *velocity, density, stress_xx, stress_yy, stress_xy))


def highest_frequency(model: Model) -> float:
    """Largest eigenfrequency ω of the free freedoms in the reference configuration [rad/s].

    Power iteration on M⁻¹K, K by differences of forces: an estimate from below, good to 0.1 % (0.2 %
    without the hourglass energy).
    """
    free = np.ones((2, model.x.size))
    free[0, model.constraints.x_index] = 0.0
    free[1, model.constraints.y_index] = 0.0
    reference = np.stack((model.x, model.y))
    step = 1e-6 * float(np.sqrt(model.volume.min()))
    shape = free * np.random.default_rng(0).standard_normal(reference.shape)
    square = 0.0
    for _ in range(POWER_ITERATIONS):
        shape *= step / np.abs(shape).max()
        pulled = internal_force(model, *(reference - shape)) - internal_force(model, *(reference + shape))
        found = float((shape * pulled).sum() / (2.0 * (model.mass * shape**2).sum()))
        shape = free * pulled / model.mass
        if abs(found - square) < 1e-5 * found:
            break
        square = found
    return float(np.sqrt(found))
