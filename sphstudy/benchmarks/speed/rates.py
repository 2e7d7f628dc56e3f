"""What a step costs: CPU seconds of each case, all cases of a group in turns."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sphstudy.benchmarks.speed.bodies import Case, made
from sphstudy.benchmarks.speed.interleave import Stepper, interleaved
from sphstudy.configuration.composition import Session

NANOSECONDS = 1e9
"""Nanoseconds of a second."""


@dataclass(frozen=True)
class Rate:
    """A case as timed. seconds [copies · rounds]: CPU time of a step. wrong: why it stopped, or "".

    pairs: unordered pairs that the system holds; interacting: those within the kernel's support, at the
    start; evaluations: of the right-hand side in a step; steps: of one turn.
    """

    case: Case
    method: str
    scene: str
    h: float
    n: int
    particles: int
    pairs: int
    interacting: int
    evaluations: int
    steps: int
    seconds: np.ndarray
    wrong: str

    @property
    def overrides(self) -> str:
        """Settings of the configuration, as on the command line."""
        return " ".join(self.case.settings)

    @property
    def step_seconds(self) -> float:
        """Median CPU time of a step [s]; NaN if the system went bad."""
        return float("nan") if self.wrong else float(np.median(self.seconds))

    @property
    def spread(self) -> float:
        """Distance between the quartiles of the rounds, over the median."""
        lower, upper = np.quantile(self.seconds, (0.25, 0.75))
        return float((upper - lower) / self.step_seconds)

    @property
    def pair_time(self) -> float:
        """CPU time per unordered pair held and evaluation [ns]."""
        return NANOSECONDS * self.step_seconds / (self.pairs * self.evaluations)

    @property
    def directed_pair_time(self) -> float:
        """The same per directed pair held [ns]."""
        return 0.5 * self.pair_time

    @property
    def interacting_pair_time(self) -> float:
        """The same per unordered pair within the support [ns]."""
        return NANOSECONDS * self.step_seconds / (self.interacting * self.evaluations)

    @property
    def particle_steps(self) -> float:
        """Particles times steps per CPU second [1/s]."""
        return self.particles / self.step_seconds


def measured(
    hydra: Session, cases: Sequence[Case], rounds: int, slice_seconds: float, copies: int = 1
) -> list[Rate]:
    """Times the cases in turns, each round about `slice_seconds` of CPU a case, one step at least.

    `copies`: systems of each case that share a turn. Where arrays happen to lie in memory changes the
    time of the same compiled code, now and then by a fifth, and alike in all rounds. Raises
    ConfigurationError if settings of a case are not valid.
    """
    systems = [made(hydra, case) for _ in range(copies) for case in cases]
    steppers = [Stepper(one.system, slice_seconds / copies) for one in systems]
    taken = interleaved(steppers, rounds)
    found = []
    for k, case in enumerate(cases):
        one, alike = systems[k], range(k, len(systems), len(cases))
        found.append(
            Rate(
                case=case,
                method=one.config.method.name,
                scene=one.config.scene.name,
                h=one.config.h,
                n=one.config.n,
                particles=one.particles,
                pairs=one.system.pairs,
                interacting=one.interacting,
                evaluations=one.evaluations,
                steps=steppers[k].steps,
                seconds=np.concatenate([taken[i] / steppers[i].steps for i in alike]),
                wrong=next((steppers[i].wrong for i in alike if steppers[i].wrong), ""),
            )
        )
    return found
