"""What would run and why: by outcome, by what is asked for, and by what an older record has else."""

import itertools

import pytest

from sphstudy.running.one_run import compute, give_up
from sphstudy.running.plan import _decision, kept, plan, print_plan
from sphstudy.store import identity
from sphstudy.store.lock import Claim
from sphstudy.store.store import Store
from tests.support.made_up import Solver, points

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


@pytest.fixture
def told(tmp_path, capsys):
    store = Store(tmp_path)

    def tell(*arguments):
        print_plan(plan(points(*arguments), store), store, workers=2)
        return capsys.readouterr().out

    return store, tell


def test_why_a_point_is_new(told, monkeypatch):
    store, tell = told
    solver = Solver(monkeypatch)
    (point,) = points("n=5")
    assert "new" in tell("n=5")
    compute(point.config, store, point.execution)
    assert "stored: done" in tell("n=5")
    assert "new: scene.E=1000000.0 is stored" in tell("n=5", "scene.E=2e6")
    assert "changed numerics" not in tell("n=5", "scene.E=2e6")
    monkeypatch.setattr(identity, "numerics_version", lambda config: "another")
    shown = tell("n=5")
    assert "changed numerics" in shown
    assert "1 runs to do" in shown
    assert "begun now, 2 at once" in shown
    assert solver.runs == [5]


def test_what_is_retried_interrupted_and_elsewhere(told):
    store, tell = told
    one, two, three = points("n=5,7,9")
    give_up(one.config, store, "failed", "killed")
    two_claim = store.claim_path(two.config)
    two_claim.write_text("left by somebody")
    Claim(store.claim_path(three.config)).take()
    shown = tell("n=5,7,9", "retry=failed")
    assert "failed, asked for again" in shown
    assert "interrupted: goes on" in shown
    assert "another sweep is computing it" in shown
    assert "2 runs to do" in shown
