"""How far a folder or a study is: each outcome by its name, with where, since when, and what is left."""

import json
import os
import platform
import time

import pytest

from sphstudy import catalogue
from sphstudy.__main__ import main
from sphstudy.running.one_run import compute, give_up
from sphstudy.store import lock
from sphstudy.store.lock import Claim
from sphstudy.store.store import Store
from tests.support.made_up import Solver, points

FILE = """
title: tiny
blocks: {grid: {scene: plate, method: tl, h: 1.3, scene.periods: 0.01, n: [5, 7, 9, 11, 13, 15, 17]}}
"""


@pytest.fixture
def store(tmp_path, monkeypatch):
    """n = 5 done, 7 failed, 9 timeout, 11 running here, 13 lost, 15 unreadable, 17 missing."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.yaml").write_text(FILE)
    monkeypatch.setitem(catalogue.FOLDERS, "studies", tmp_path)
    monkeypatch.setattr(lock, "NOTE_INTERVAL", 0.0)
    # The claim of another machine is to stay as old as it is made here.
    monkeypatch.setattr(lock, "HEARTBEAT", 1e6)
    Solver(monkeypatch)
    store = Store("results")
    done, failed, late, running, lost, damaged, _ = points("n=5,7,9,11,13,15,17")
    compute(done.config, store, done.execution)
    give_up(failed.config, store, "failed", "[red]killed[/x]")
    give_up(late.config, store, "timeout", "too late")
    mine = Claim(store.claim_path(running.config))
    mine.take()
    mine.update(250, 1000)
    other = Claim(store.claim_path(lost.config))
    other.take()
    other.update(7, 1000)
    note = json.loads(other.path.read_text())
    other.path.write_text(json.dumps({**note, "host": "elsewhere"}))
    os.utime(other.path, (1.0, 1.0))
    store.record_path(damaged.config).write_text("no record")
    return store


def lines(shown):
    """Lines by n, and the last ones."""
    found = {}
    for line in shown.splitlines():
        if "-n" in line:
            found[int(line.split("-n")[1].split("-")[0])] = line
    return found


HERE = f"step 250 of 1,000, process {os.getpid()} on {platform.node()}, since "


def test_every_outcome_of_a_folder(store, capsys):
    for _ in range(2):
        assert main(["status"]) == 0
        shown = capsys.readouterr().out
        found = lines(shown)
        assert " done " in found[5]
        assert " failed " in found[7]
        assert "[red]killed[/x]" in found[7]
        assert " timeout " in found[9]
        assert " running " in found[11]
        assert HERE in found[11]
        assert found[11].rstrip().endswith("alive")
        assert " interrupted " in found[13]
        assert "step 7 of 1,000" in found[13]
        assert "on elsewhere, since " in found[13]
        assert found[13].rstrip().endswith("lost")
        assert " unreadable " in found[15]
        assert set(found) == {5, 7, 9, 11, 13, 15}
        last = shown.splitlines()[-1]
        for count in ("1 done", "1 failed", "1 timeout", "1 running", "1 interrupted", "1 unreadable"):
            assert count in last


def test_every_outcome_of_a_study_and_what_is_left(store, capsys):
    assert main(["status", "tiny"]) == 0
    shown = capsys.readouterr()
    found = lines(shown.out)
    for n, outcome in {5: "done", 7: "failed", 9: "timeout", 11: "running", 13: "interrupted"}.items():
        assert f" {outcome} " in found[n]
    assert " missing" in found[15]
    assert " missing" in found[17]
    assert "3 of 7 points have a record" in shown.out
    assert "an hour while the last 3 were made" in shown.out
    assert "4 left, about " in shown.out
    assert "n15" in shown.err
    assert "unreadable" in shown.err


def test_a_run_that_was_killed_when_all_was_done_is_done(store, capsys):
    (done,) = points("n=5")
    lost = next(p for p in store.runs.glob("*-n13-*.running.json"))
    store.claim_path(done.config).write_bytes(lost.read_bytes())
    os.utime(store.claim_path(done.config), (1.0, 1.0))
    for arguments in (["status"], ["status", "tiny"]):
        main(arguments)
        assert " done " in lines(capsys.readouterr().out)[5]


def test_a_run_that_was_interrupted_and_can_go_on_is_listed(store, capsys):
    (missing,) = points("n=17")
    store.checkpoint_path(missing.config).write_text("")
    for arguments in (["status"], ["status", "tiny"]):
        main(arguments)
        line = lines(capsys.readouterr().out)[17]
        assert " interrupted " in line
        assert "goes on from its checkpoint" in line


def test_a_clock_that_was_set_back_changes_no_outcome(store, capsys):
    main(["status"])
    capsys.readouterr()
    main(["status"])
    before = capsys.readouterr().out
    future = time.time() + 1e6
    for path in store.runs.iterdir():
        if path.suffix == ".nc" or "-n11-" in path.name:
            os.utime(path, (future, future))
    main(["status"])
    assert capsys.readouterr().out == before
    assert main(["status", "tiny"]) == 0


@pytest.mark.parametrize("arguments", [["nothing"], ["results=nowhere"], ["results="], ["tiny", "n=x"]])
def test_wrong_arguments_are_answered(arguments, store, capsys):
    assert main(["status", *arguments]) == 2
    assert capsys.readouterr().err.startswith("sphstudy: ")
