"""Whether a body at rest, shaken a little, comes to rest or blows up: what a stable time step means."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from sphstudy.model.problem import Problem, Stage
from sphstudy.numerics.solvers.system import System

SPEED = 1e-5
"""Of the shaking, root mean square over the wave speed: strains are of this order, so all is linear."""

SHAPED = 1e4
"""Kinetic energy gained, at a step too long, by which what grows fastest has come out of the noise."""

BLOWN_UP = 1e6
"""Energy over that at first: speeds are then a hundredth of the wave speed. Near its limit, Verlet's
energy swings, but by less.
"""

GROWN = 1e-3
"""By how much the mean energy of a trial's last quarter exceeds that of the second, relatively, ..."""

SCATTER = 5.0
"""... and by so many standard errors of the two means: below its limit, Verlet's energy swings."""

SAMPLES = 1000
"""Of the energy in a trial, at random steps: evenly spaced ones could beat with an oscillation."""

_VELOCITY = slice(2, 4)
"""Rows of a state that hold velocities, whatever the system."""


class Trial(NamedTuple):
    """unstable: whether it gained energy. steps: how many it took to tell."""

    unstable: bool
    steps: int


class Bracket(NamedTuple):
    """The longest stable and the shortest unstable time step found, in the unit that they were searched
    in; NaN where all were stable, or none. trials: how many, of how many steps in all.
    """

    stable: float
    unstable: float
    trials: int
    steps: int


def noise(problem: Problem, seed: int) -> np.ndarray:
    """Random velocities [2, N] (m/s) of all particles that are not held, of root mean square 1 m/s."""
    velocity = np.random.default_rng(seed).standard_normal((2, problem.body.x.size))
    velocity[0, problem.constraints.x_index] = 0.0
    velocity[1, problem.constraints.y_index] = 0.0
    return normalised(velocity)


def normalised(velocity: np.ndarray) -> np.ndarray:
    """The velocities [2, N] scaled to a root mean square of 1."""
    return velocity / np.sqrt(np.mean(velocity**2))


def fastest_growing(system: System, stage: Stage, steps: int) -> np.ndarray | None:
    """Velocities [2, N] of what grows fastest out of those that the system starts with, of root mean
    square 1 m/s; None if nothing grows within so many steps.
    """
    if system.begin(stage, 0.0, None):
        return None
    first = float((system.state[_VELOCITY] ** 2).sum())
    for step in range(steps):
        wrong = system.advance(step, step + 1)[1]
        velocity = system.state[_VELOCITY]
        size = float((velocity**2).sum())
        if not np.isfinite(size):
            return None
        if size > SHAPED * first:
            return normalised(velocity)
        if wrong:
            return None
    return None


def shaken(system: System, stage: Stage, steps: int, seed: int) -> Trial:
    """Steps the system, which starts in motion, with its constraints held, and tells whether its energy
    grows: BLOWN_UP at any time, or from the second quarter to the last (GROWN, SCATTER).
    """
    if system.begin(stage, 0.0, None):
        return Trial(True, 0)
    chosen = np.random.default_rng(seed).choice(
        np.arange(1, steps + 1), min(SAMPLES, steps), replace=False
    )
    energies, first, before = [], _energy(system), 0
    for step in np.sort(chosen).tolist():
        reached, wrong = system.advance(before, step)
        energy = np.nan if wrong else _energy(system)
        if not energy <= BLOWN_UP * first:
            return Trial(True, reached)
        energies.append(energy)
        before = step
    return Trial(_grew(np.array(energies)), before)


def _grew(energies: np.ndarray) -> bool:
    _, second, _, last = np.array_split(energies, 4)
    error = np.sqrt(second.var() / second.size + last.var() / last.size)
    return bool(last.mean() - second.mean() > GROWN * second.mean() + SCATTER * error)


def _energy(system: System) -> float:
    totals = system.totals()
    return totals.kinetic_energy + totals.strain_energy


def bisect(
    trial: Callable[[float], Trial],
    lowest: float,
    highest: float,
    tolerance: float,
    on_trial: Callable[[int], None],
) -> Bracket:
    """Halves the ratio of two time steps until it is within 1 + `tolerance`; `trial` tells whether a step
    is stable. Calls on_trial(trials so far) after each.
    """
    steps, trials = 0, 0

    def unstable(courant: float) -> bool:
        nonlocal steps, trials
        found = trial(courant)
        steps, trials = steps + found.steps, trials + 1
        on_trial(trials)
        return found.unstable

    if not unstable(highest):
        return Bracket(highest, np.nan, trials, steps)
    if unstable(lowest):
        return Bracket(np.nan, lowest, trials, steps)
    lowest, highest = narrowed(lambda courant: not unstable(courant), lowest, highest, tolerance)
    return Bracket(lowest, highest, trials, steps)


def narrowed(
    is_stable: Callable[[float], bool], stable: float, unstable: float, tolerance: float
) -> tuple[float, float]:
    """A stable and an unstable time step closer to each other: their ratio within 1 + `tolerance`.

    Parameters
    ----------
    is_stable : callable
        Whether a time step is stable; called for steps between the two.
    stable, unstable : float
        Time steps in any unit, the stable one shorter.
    tolerance : float
        Of the ratio.
    """
    while unstable > (1.0 + tolerance) * stable:
        middle = float(np.sqrt(stable * unstable))
        if is_stable(middle):
            stable = middle
        else:
            unstable = middle
    return stable, unstable
