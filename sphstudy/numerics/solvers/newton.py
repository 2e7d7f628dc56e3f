"""Static equilibrium of a potential for prescribed displacements: Newton's method with line search."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse

from sphstudy.numerics.solvers.factorisation import Factorisation, NotSolvable, along_body
from sphstudy.numerics.sph import stiffness, total_lagrangian
from sphstudy.numerics.sph.total_lagrangian import Model

SUFFICIENT = 1e-4
"""Share of the decrease that the slope promises which a step must keep (Armijo 1966)."""

ROUGHEST = 1e-4
"""Largest residual that may be left by the rounding of positions."""

HALVINGS = 12
"""Of a Newton step, before the line search gives up."""


@dataclass
class Effort:
    """What solutions took: linear systems solved, entries of factors at most, largest residual."""

    systems: int = 0
    entries: int = 0
    residual: float = 0.0


class Newton:
    """Equilibria of one model.

    A residual is the norm of the forces on free particles over that of the forces on all; equilibrium is
    one of at most `tolerance`, found in at most `iterations` steps. Where the load is so small that the
    rounding of positions makes larger forces, equilibrium is what leaves no more than these.
    """

    def __init__(self, model: Model, tolerance: float, iterations: int, effort: Effort):
        self.model, self.tolerance, self.iterations, self.effort = model, tolerance, iterations, effort
        self._held, self._free = freedoms(model)
        self._target = np.concatenate((model.constraints.x_target, model.constraints.y_target))
        self._reference = np.concatenate((model.x, model.y))
        self._operators = stiffness.operators(model)
        self._work = total_lagrangian.workspace(model.x.size)
        self._order = freedoms_along_body(model, self._free)
        self._factors: Factorisation | None = None

    def equilibrium(self, position: np.ndarray, amplitude: float) -> np.ndarray:
        """Positions [2N] (m) at rest with prescribed freedoms at target · amplitude, from a start.

        Raises NotSolvable, and leaves the start as it was.
        """
        force, held = self._force(position), self._held
        if self.model.law.objective:
            self._factors = None
        stiff = self._tangent()
        drive = np.zeros(position.size)
        drive[held] = self._reference[held] + amplitude * self._target - position[held]
        step = self._factors_of(stiff).solve((force - stiff @ drive)[self._free])
        self.effort.systems += 1
        # Prescribed freedoms go all the way in the first step, the others with them as the tangent says.
        position = position + drive
        position[self._free] += step
        force = self._force(position)
        self._refuse_inverted()
        before = np.inf
        for iteration in range(self.iterations + 1):
            residual = self._residual(force)
            stuck = residual > 0.5 * before and self._is_rounding(position, force)
            if residual <= self.tolerance or (stuck and residual <= ROUGHEST):
                self.effort.residual = max(self.effort.residual, residual)
                return position
            if stuck:
                raise NotSolvable(
                    f"rounding of positions leaves a residual of {residual:.1e}: the load is too small"
                )
            if iteration == self.iterations:
                break
            before = residual
            if self.model.law.objective:
                self._factors = None
            step = self._factors_of(self._tangent()).solve(force[self._free])
            self.effort.systems += 1
            position, force = self._searched(position, force, step)
        raise NotSolvable(
            f"no equilibrium, iteration {self.iterations} leaves a residual of {residual:.1e}"
        )

    def _force(self, position: np.ndarray) -> np.ndarray:
        force = np.zeros((2, self.model.x.size))
        total_lagrangian.force(self.model, *position.reshape(2, -1), self._work, force)
        return force.ravel()

    def _energy(self, position: np.ndarray) -> float:
        return sum(total_lagrangian.energies(self.model, *position.reshape(2, -1), self._work))

    def _residual(self, force: np.ndarray) -> float:
        total = float(np.linalg.norm(force))
        return float(np.linalg.norm(force[self._free])) / total if total else 0.0

    def _is_rounding(self, position: np.ndarray, force: np.ndarray) -> bool:
        """Whether the forces on free particles are no larger than those that the rounding of their
        positions makes.
        """
        makes = np.finfo(float).eps * (abs(self._stiffness) @ abs(position))
        return bool(np.linalg.norm(force[self._free]) <= np.linalg.norm(makes[self._free]))

    def _tangent(self) -> sparse.csc_array:
        """The tangent at the deformation gradients that the last force has left."""
        if self._factors is None or self.model.law.objective:
            self._stiffness = stiffness.tangent(self.model, self._operators, self._work.gradient)
        return self._stiffness

    def _factors_of(self, stiff: sparse.csc_array) -> Factorisation:
        if self._factors is None:
            self._factors = Factorisation(stiff[self._free][:, self._free], self._order)
            self.effort.entries = max(self.effort.entries, self._factors.entries)
        return self._factors

    def _searched(
        self, position: np.ndarray, force: np.ndarray, step: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Position and force after the longest of step, step/2, … that lowers energy or residual."""
        slope = float(force[self._free] @ step)
        if not slope > 0.0:
            raise NotSolvable("the step goes up: residual and stiffness have lost all digits")
        energy, residual = self._energy(position), float(np.linalg.norm(force[self._free]))
        share = 1.0
        for _ in range(HALVINGS):
            tried = position.copy()
            tried[self._free] += share * step
            found = self._force(tried)
            if self._inverted() == 0:
                lower = self._energy(tried) <= energy - SUFFICIENT * share * slope
                # Close to equilibrium energies differ by less than their rounding; residuals do not.
                if lower or np.linalg.norm(found[self._free]) <= (1.0 - SUFFICIENT * share) * residual:
                    return tried, found
            share *= 0.5
        raise NotSolvable("the line search finds nothing lower")

    def _inverted(self) -> int:
        return total_lagrangian.inverted(self.model.law, self._work.gradient)

    def _refuse_inverted(self) -> None:
        if count := self._inverted():
            raise NotSolvable(f"inverted deformation gradients, det F ≤ 0 ({count} of them)")


def freedoms(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Held freedoms, in the order of the constraints' targets, and free ones (of 2N, x before y)."""
    count, constraints = model.x.size, model.constraints
    held = np.concatenate((constraints.x_index, count + constraints.y_index))
    return held, np.setdiff1d(np.arange(2 * count), held)


def freedoms_along_body(model: Model, free: np.ndarray) -> np.ndarray:
    """Order [M] of the free freedoms [M] (of 2N, x before y) that makes a narrow band."""
    count = model.x.size
    place = np.empty(count, np.int64)
    place[along_body(model.x, model.y)] = np.arange(count)
    return np.argsort(2 * place[free % count] + (free >= count))
