"""Updated Lagrangian models as a System: Heun's method on the rates, with neighbours that move."""

from collections.abc import Callable

import numpy as np

from sphstudy.model.problem import Problem, Stage
from sphstudy.numerics.solvers.heun import OUTDATED, REACHED, advance, buffers
from sphstudy.numerics.sph import rate_invariants
from sphstudy.numerics.sph.invariants import Invariants
from sphstudy.numerics.sph.neighbours import look, outdated
from sphstudy.numerics.sph.updated_lagrangian import (
    RHO,
    STATE_ROWS,
    VX,
    VY,
    Model,
    X,
    Y,
    build_neighbours,
    fastest,
    neighbours_at,
    rates,
)


class RateSystem:
    """A problem whose model gives time derivatives of the state [8, N] (sph.updated_lagrangian).

    dt (s); `model`: from the number of open crack nodes to the model; threads: how many sum over pairs.
    """

    def __init__(self, problem: Problem, dt: float, model: Callable[[int], Model], threads: int = 1):
        self.problem, self.dt, self._model_of, self._threads = problem, dt, model, threads
        body = problem.body
        self.state = np.zeros((STATE_ROWS, body.x.size))
        self.state[: Y + 1] = problem.start
        self.state[VX], self.state[VY] = problem.velocity_x, problem.velocity_y
        self.state[RHO] = body.material.density
        self.pairs = 0
        self._rate = np.zeros_like(self.state)

    def begin(self, stage: Stage, amplitude_rate: float, kept: dict[str, np.ndarray] | None) -> str:
        """See System."""
        self.model, self.amplitude_rate = self._model_of(stage.crack_nodes), amplitude_rate
        self._buffers = buffers(self.model, self.state.shape[1], self._threads)
        if kept is None:
            return self._renew_neighbours()
        self._list = neighbours_at(self.model, kept["list_x"], kept["list_y"], float(kept["list_skin"]))
        return ""

    def advance(self, begin: int, end: int) -> tuple[int, str]:
        """See System."""
        step = begin
        while step < end:
            step, reason = advance(
                self.model, self.state, self._list, self._buffers, self.amplitude_rate, self.dt, step, end
            )
            wrong = self._renew_neighbours() if reason == OUTDATED else ""
            if wrong or reason not in (OUTDATED, REACHED):
                return step, wrong or self._indicator()
        return step, ""

    def _renew_neighbours(self) -> str:
        stride = self.dt * fastest(self.model, self.state, self.amplitude_rate)
        pairs = build_neighbours(self.model, self.state, stride)
        if pairs is None:
            return self._indicator()
        self._list = pairs
        self.pairs = max(self.pairs, pairs.total)
        return ""

    def _indicator(self) -> str:
        if not np.isfinite(self.state).all():
            return "a value that is not finite"
        if not (self.state[RHO] > 0.0).all():
            return "a density ≤ 0"
        faster = (self.state[VX] ** 2 + self.state[VY] ** 2) * self.state[RHO] > self.model.bulk_modulus
        return "a particle faster than sound" if faster.any() else "a step too far"

    def totals(self) -> Invariants:
        """See System. The strain energy is that of (3.18)."""
        # A list built here is not handed on: looking must not change what is looked at.
        pairs = self._list
        if outdated(pairs, self.state[X], self.state[Y], 0.0):
            pairs = build_neighbours(self.model, self.state) or pairs
        look(pairs, self.state[X], self.state[Y], self.model.crack)
        rates(self.model, self.state, pairs, self.amplitude_rate, self._buffers.work, self._rate)
        return rate_invariants.measure(
            self.state,
            self._rate,
            self.problem.body.mass,
            *self.problem.energy_compliance,
            self.problem.constraints,
            self.amplitude_rate,
            pairs,
        )

    def fields(self) -> np.ndarray:
        """See System."""
        return self.state.copy()

    def closure_work(self) -> float:
        """Forces of bonds that are cut are not known apart here."""
        return np.nan

    def memory(self) -> dict[str, np.ndarray]:
        """What the neighbour list in force was built from: renewed at a restart, it would add the same
        pairs in another order.
        """
        return {
            "list_x": self._list.built_x,
            "list_y": self._list.built_y,
            "list_skin": np.array(self._list.skin),
        }
