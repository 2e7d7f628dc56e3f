"""Rates of real systems: what they count, never how long it takes."""

import numpy as np

from sphstudy.benchmarks.speed.bodies import Case
from sphstudy.benchmarks.speed.rates import measured
from sphstudy.configuration.composition import session


def test_copies_of_a_case_are_timed_as_one():
    cases = [
        Case("tl, plate", "forms", ("scene=plate", "n=5", "method=tl", "h=1.3")),
        Case("thesis, plate", "forms", ("scene=plate", "n=5", "method=thesis", "h=1.5")),
    ]
    with session() as hydra:
        found = measured(hydra, cases, rounds=2, slice_seconds=0.003, copies=3)
    assert [rate.method for rate in found] == ["tl", "thesis"]
    assert [rate.evaluations for rate in found] == [1, 2]
    for rate in found:
        assert rate.seconds.shape == (6,)
        assert (rate.seconds > 0.0).all()
        assert rate.particles == 300
        assert rate.pairs >= rate.interacting
        assert not rate.wrong
        assert np.isclose(rate.pair_time * rate.pairs, rate.interacting_pair_time * rate.interacting)


def test_a_system_that_goes_bad_says_so():
    unstable = ("scene=plate", "n=5", "method=tl", "h=1.3", "solve.courant=20")
    with session() as hydra:
        (rate,) = measured(hydra, [Case("tl", "forms", unstable)], rounds=2, slice_seconds=0.05)
    assert rate.wrong
    assert np.isnan(rate.step_seconds)
