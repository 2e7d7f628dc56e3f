"""A process of its own until its first step."""

import resource

import numpy as np
import pytest

from sphstudy.benchmarks.speed import start


def test_a_process_tells_its_own_seconds_and_its_own_memory():
    one = start._start("tl", 5, False, "")
    assert one.particles == 300
    assert 0.0 < one.load_seconds < one.step_seconds
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    # This process's peak must not become that of the processes it starts.
    filled = np.ones(60_000_000)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss > before
    again = start._start("tl", 5, False, "")
    assert filled.nbytes > one.peak_memory
    assert abs(again.peak_memory - one.peak_memory) < 0.2 * one.peak_memory


def test_a_process_that_fails_leaves_its_last_words():
    with pytest.raises(RuntimeError, match=r"n=4.*must be odd"):
        start._start("tl", 4, False, "")
