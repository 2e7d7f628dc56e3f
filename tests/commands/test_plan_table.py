"""What would run and why, on the console: also by what an older record has else."""

import pytest

from sphstudy.commands.plan_table import print_plan
from sphstudy.running.one_run import compute, give_up
from sphstudy.running.plan import plan
from sphstudy.store import identity
from sphstudy.store.lock import Claim
from sphstudy.store.store import Store
from tests.support.made_up import Solver, points


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
