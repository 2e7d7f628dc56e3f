"""Measurements made up without timing anything."""

import numpy as np

from sphstudy.benchmarks.speed import cases
from sphstudy.benchmarks.speed.bodies import SHUFFLED, Case
from sphstudy.benchmarks.speed.measurements import Measurements, Part
from sphstudy.benchmarks.speed.parallel import Scaling
from sphstudy.benchmarks.speed.rates import Rate
from sphstudy.benchmarks.speed.start import Start
from sphstudy.benchmarks.speed.whole_runs import WholeRun

EVALUATIONS = {"thesis": 2, "tl": 1}


def rate(case: Case, nanoseconds: float, particles: int = 1000, wrong: str = "") -> Rate:
    """A case that takes so long per unordered pair and evaluation, in the median of three rounds."""
    method = case.label.partition(",")[0]
    pairs, evaluations = 10 * particles, EVALUATIONS[method]
    step = 1e-9 * nanoseconds * pairs * evaluations
    return Rate(
        case=case,
        method=method,
        scene="plate",
        h=1.5,
        n=9,
        particles=particles,
        pairs=pairs,
        interacting=8 * particles,
        evaluations=evaluations,
        steps=7,
        seconds=step * np.array([1.0, 1.5, 0.9]),
        wrong=wrong,
    )


def measurements() -> Measurements:
    """Something of every part. On the perturbed plates tl's time per pair grows from 5 to 6.5 ns."""
    forms = [rate(case, 10.0 + k) for k, case in enumerate(cases.forms())]
    growth = [
        rate(case, 5.0 + 0.5 * k + 30.0 * (case.arrangement == SHUFFLED), 10 ** (k + 3))
        for form in cases.growth()
        for k, case in enumerate(form)
    ]
    terms = [rate(case, {"all": 20.0, "none": 8.0}.get(case.variant, 15.0)) for case in cases.terms(20)]
    sweep = np.array([[4.0, 4.2], [2.5, 2.1]])
    control = np.array([[1.0, 1.0], [0.5, 0.625]])
    return Measurements(
        rates=[*forms, *growth, *terms],
        scalings=[Scaling("4 runs", "processes", sweep, control, "two processes")],
        starts=[Start("tl", 9, True, 972, 1.5, 20.0, 18.0, 3e8)],
        runs=[
            WholeRun("tl, modes of the plate", "solve=modes", "done", np.array([0.1, 0.3, 0.2]), "direct")
        ],
        parts=[Part("forms", 12.0, 3.0, 13.0)],
    )
