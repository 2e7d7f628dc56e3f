"""What is stale is listed with its reason, and removed only if asked; what serves stays."""

import json
import os
import shutil
import time

import pytest

from sphstudy.__main__ import main
from sphstudy.running import one_run
from sphstudy.running.one_run import compute, give_up
from sphstudy.store import identity
from sphstudy.store.lock import Claim
from sphstudy.store.netcdf import write
from sphstudy.store.stale import FORGOTTEN
from sphstudy.store.store import Store
from tests.support.made_up import Solver, points, solved


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """One of each: {name: reason or None if it serves}."""
    Solver(monkeypatch)
    monkeypatch.chdir(tmp_path)
    store, expected = Store("results"), {}
    done, failed, running, interrupted, old, invalid, lost = points("n=5,7,9,11,13,15,17")

    compute(done.config, store, done.execution)
    give_up(failed.config, store, "failed", "killed")
    for kind in (store.record_path, store.log_path):
        expected |= {kind(done.config).name: None, kind(failed.config).name: None}

    Claim(store.claim_path(running.config)).take()
    for kind in (store.claim_path, store.checkpoint_path, store.log_path):
        path = kind(running.config)
        path.touch()
        expected[path.name] = None

    # Interrupted: the next sweep goes on from its checkpoint.
    store.claim_path(interrupted.config).write_text("{}")
    store.checkpoint_path(interrupted.config).touch()
    expected[store.checkpoint_path(interrupted.config).name] = None
    expected[store.claim_path(interrupted.config).name] = "a claim whose process is gone"

    run = solved(old.config)
    run.attrs |= {"date_created": "", "numerics_version": "older"}
    write(run, store.record_path(old.config))
    expected[store.record_path(old.config).name] = "changed numerics"

    run = solved(invalid.config)
    values = json.loads(run.attrs["configuration"]) | {"h": -1}
    run.attrs |= {"date_created": "", "configuration": json.dumps(values)}
    write(run, store.record_path(invalid.config))
    expected[store.record_path(invalid.config).name] = "not valid any more: h=-1"

    store.log_path(lost.config).write_text("a log")
    store.checkpoint_path(lost.config).touch()
    os.utime(store.checkpoint_path(lost.config), (0.0, time.time() - FORGOTTEN - 60.0))
    store.checkpoint_path(failed.config).touch()
    expected[store.checkpoint_path(failed.config).name] = None
    expected[store.log_path(lost.config).name] = "a log of a run without a record"
    expected[store.checkpoint_path(lost.config).name] = "a checkpoint that nobody"

    (store.runs / "x-0000000000000000.nc").write_text("no record")
    expected["x-0000000000000000.unreadable"] = "set aside"
    (store.runs / "y-0000000000000000.unreadable").mkdir()
    expected["y-0000000000000000.unreadable"] = "set aside"
    (store.runs / ".writing-1.nc").touch()
    expected[".writing-1.nc"] = None
    return store, expected


def names(store):
    return {p.name for p in store.runs.iterdir()} - {".claims"}


def test_each_kind_is_listed_with_its_reason_and_nothing_is_removed(folder, capsys):
    store, expected = folder
    assert main(["prune"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for name, reason in expected.items():
        found = [line for line in lines if name in line]
        assert len(found) == (reason is not None), (name, found)
        assert reason is None or reason in found[0]
    assert any(line.startswith("stale: 7 files") for line in lines), lines
    assert names(store) == set(expected)


def test_only_what_is_listed_is_removed(folder, capsys):
    store, expected = folder
    assert main(["prune", "--yes", "results=results"]) == 0
    assert "removed: 7 files" in capsys.readouterr().out
    assert names(store) == {name for name, reason in expected.items() if reason is None}
    assert main(["prune"]) == 0


def test_an_unfinished_write_goes_when_nobody_writes(folder, capsys):
    store, _ = folder
    for path in store.runs.glob("*-n9-*"):
        path.unlink()
    main(["prune", "--yes"])
    assert not list(store.runs.glob(".writing-*"))


@pytest.mark.parametrize("arguments", [["results=nowhere"], ["foo"], ["results="], ["x=1"]])
def test_wrong_arguments_are_answered(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["prune", *arguments]) == 2
    assert capsys.readouterr().err.startswith("sphstudy: ")


def test_a_record_of_changed_code_is_stale_and_what_is_in_use_is_not(folder, monkeypatch, capsys):
    store, _ = folder
    shutil.rmtree(store.runs / "y-0000000000000000.unreadable")
    monkeypatch.setattr(identity, "numerics_version", lambda config: "newer")
    monkeypatch.setattr(one_run.identity, "numerics_version", lambda config: "newer")
    main(["prune", "--yes"])
    left = names(store)
    assert not any(name.endswith(".nc") and not name.startswith(".") for name in left)
    assert any("-n9-" in name and name.endswith(".running.json") for name in left)
