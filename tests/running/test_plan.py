"""What would run and why: by outcome, by what is asked for, and by what an older record has else."""

import itertools

import pytest

from sphstudy.errors import ConfigurationError
from sphstudy.running.one_run import give_up
from sphstudy.running.plan import _decision, kept, plan
from sphstudy.store.store import Store
from tests.support.made_up import points

OUTCOMES = ("missing", "interrupted", "running", "done", "diverged", "failed", "timeout")
RUNS = {
    "none": {"missing", "interrupted"},
    "failed": {"missing", "interrupted", "failed"},
    "timeout": {"missing", "interrupted", "timeout"},
    "all": {"missing", "interrupted", "failed", "timeout"},
}


@pytest.mark.parametrize(("status", "retry"), list(itertools.product(OUTCOMES, RUNS)))
def test_which_outcomes_run(status, retry):
    runs, reason = _decision(status, retry, force=False)
    assert runs is (status in RUNS[retry])
    assert reason
    forced, _ = _decision(status, retry, force=True)
    assert forced is (status != "running")


def test_failed_points_that_are_kept_are_said(tmp_path):
    store, (one, other) = Store(tmp_path), points("n=5,7")
    give_up(one.config, store, "failed", "killed")
    give_up(other.config, store, "timeout", "late")
    assert kept(plan([one, other], store)) == (
        "1 failed (retry=failed runs them again), 1 timeout (retry=timeout runs them again)"
    )


def test_a_run_of_years_needs_a_limit_that_says_so(tmp_path):
    settings = ("n=5", "solve.courant=1e-14")
    with pytest.raises(ConfigurationError, match=r"would take about .* h of CPU time"):
        plan(points(*settings), Store(tmp_path))
    (planned,) = plan(points(*settings, "time_limit=60"), Store(tmp_path))
    assert planned.runs
