"""Stability limit of a code: the largest C of its time step with which short runs stay sound."""

from collections.abc import Callable

from sphstudy.numerics.solvers.growth import narrowed

STEP = 1.25
"""Factor between trials while the limit is not enclosed."""

RESOLUTION = 0.02
"""The limit is known when the unsound C is larger than a sound one by no more than this share of it."""

RANGE = (0.02, 20.0)
"""C outside of which no limit is looked for."""


class NoLimit(RuntimeError):
    """There is no limit within the range."""


def stability_limit(is_stable: Callable[[float], bool], guess: float) -> float:
    """The largest C found stable, by bisection on a logarithmic scale about a guess.

    Raises NoLimit if everything in RANGE is stable or nothing is.
    """
    stable = unstable = None
    trial = guess
    while stable is None or unstable is None:
        if not RANGE[0] <= trial <= RANGE[1]:
            raise NoLimit(f"no limit of C found between {RANGE[0]:g} and {RANGE[1]:g}")
        if is_stable(trial):
            stable, trial = trial, trial * STEP
        else:
            unstable, trial = trial, trial / STEP
    return narrowed(is_stable, stable, unstable, RESOLUTION)[0]
