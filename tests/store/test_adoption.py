"""Records of an earlier version, made up: adopted once, without a number changed, and never at a cost."""

import json
import os

import pytest

from sphstudy.__main__ import main
from sphstudy.commands.plan_table import print_plan
from sphstudy.running.one_run import compute
from sphstudy.running.plan import plan
from sphstudy.store import adoption, identity
from sphstudy.store.adoption import adopt, adoptable
from sphstudy.store.lock import Claim
from sphstudy.store.netcdf import load, write
from sphstudy.store.store import Store, read_summary
from sphstudy.store.summary import of_record
from tests.support.made_up import Solver, points

NUMERICS = "d4c4e5ea3c59"
"""A version that is adopted."""

METRICS = "of before"
"""A version of metrics that has not changed since."""


@pytest.fixture
def store(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (point,) = points("n=5")
    monkeypatch.setitem(adoption._known()["metrics"], METRICS, identity.metrics_version(point.config))
    return Store("results")


def old_record(store, point, **attributes):
    """The path of the record as an earlier version would have written it."""
    compute(point.config, store, point.execution)
    new = store.record_path(point.config)
    run = load(new)
    configuration = json.loads(run.attrs["configuration"])
    configuration["solve"] |= {"damping": configuration["method"].pop("damping"), "smoothing": 0.0}
    key = f"{point.config.n:016d}"
    run.attrs |= {
        "configuration": json.dumps(configuration),
        "key": key,
        "numerics_version": NUMERICS,
        "metrics_version": METRICS,
        **attributes,
    }
    old = new.with_name(f"{point.config.label}-{key}.nc")
    write(run, old, text=of_record(run).text)
    new.unlink()
    os.rename(store.log_path(point.config), old.with_suffix(".log"))
    return old


def test_an_old_record_serves_today_with_the_same_numbers(store, monkeypatch, capsys):
    solver = Solver(monkeypatch)
    (point,) = points("n=5")
    old = old_record(store, point)
    before, summary = load(old), read_summary(old)
    assert adoptable(summary.attributes)
    assert store.status(point.config) == "missing"
    print_plan(plan([point], store), store, 1)
    assert "with the same numbers: `sphstudy adopt` keeps it" in capsys.readouterr().out
    assert main(["prune"]) == 0
    assert old.name not in capsys.readouterr().out
    assert main(["adopt"]) == 0
    assert "1 records adopted, 0 left" in capsys.readouterr().out
    assert not old.exists()
    assert store.log_path(point.config).exists()
    assert store.status(point.config) == "done"
    after = store.read(point.config)
    assert after.attrs["metrics_version"] == identity.metrics_version(point.config)
    for name, variable in before.variables.items():
        assert variable.values.tobytes() == after[name].values.tobytes(), name
    compute(point.config, store, point.execution)
    assert solver.runs == [5]
    assert adopt(store).adopted == []


def test_a_move_that_was_killed_in_between_is_finished(store, monkeypatch):
    Solver(monkeypatch)
    (point,) = points("n=5")
    old = old_record(store, point)
    whole = old.read_bytes()
    adopt(store)
    new = store.record_path(point.config)
    stamp = new.stat().st_mtime_ns
    old.write_bytes(whole)
    assert adopt(store).adopted == [old.name]
    assert not old.exists()
    assert new.stat().st_mtime_ns == stamp


def test_a_record_of_the_new_name_is_not_overwritten(store, monkeypatch):
    Solver(monkeypatch)
    (point,) = points("n=5")
    old = old_record(store, point, date_created="2001-01-01T00:00:00Z")
    compute(point.config, store, point.execution)
    before = store.record_path(point.config).read_bytes()
    assert "already" in adopt(store).left[old.name]
    assert old.exists()
    assert store.record_path(point.config).read_bytes() == before


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"numerics_version": "0123456789ab"}, "another version"),
        ({"configuration": json.dumps({"h": 1.3})}, "not valid any more"),
        ({"configuration": '{"scene": {}, "method": {}, "solve": {}}'}, "not valid any more"),
    ],
)
def test_what_cannot_be_adopted_is_named_and_left(store, monkeypatch, capsys, changed, reason):
    Solver(monkeypatch)
    (point,) = points("n=5")
    old = old_record(store, point, **changed)
    assert main(["adopt", "results=results"]) == 0
    shown = capsys.readouterr().out
    assert f"{old.name}: left as it is" in shown
    assert reason in shown
    assert old.exists()


def test_nothing_is_adopted_once_the_numerics_have_changed(store, monkeypatch):
    Solver(monkeypatch)
    (point,) = points("n=5")
    old = old_record(store, point)
    monkeypatch.setattr(identity, "numerics_version", lambda config: "2")
    assert "the numerics have changed" in adopt(store).left[old.name]


def test_a_run_that_is_being_computed_is_left_to_its_process(store, monkeypatch):
    Solver(monkeypatch)
    (point,) = points("n=5")
    old = old_record(store, point)
    with Claim(store.claim_path(point.config)) as claim:
        claim.take()
        assert "being computed" in adopt(store).left[old.name]
    assert adopt(store).adopted == [old.name]


def test_metrics_of_other_code_are_measured_again_when_they_are_read(store, monkeypatch):
    Solver(monkeypatch)
    (point,) = points("n=5")
    old_record(store, point, metrics_version="0123456789ab")
    adopt(store)
    assert store.summary(point.config).attributes["metrics_version"] == "0123456789ab"


def test_settings_keep_their_values_where_they_have_moved():
    configuration = {
        "h": 1.3,
        "scene": {"kind": "swinging_plate"},
        "method": {"kind": "updated_lagrangian"},
        "solve": {"damping": 0.5, "smoothing": 0.25, "courant": 0.8},
    }
    before = json.dumps(configuration)
    assert adoption.translated(configuration) == {
        "h": 1.3,
        "scene": {"kind": "plate"},
        "method": {"kind": "updated_lagrangian", "damping": 0.5, "smoothing": 0.25},
        "solve": {"courant": 0.8},
    }
    assert json.dumps(configuration) == before


@pytest.mark.parametrize("arguments", [["foo"], ["results="], ["results=nowhere"]])
def test_wrong_arguments_are_answered(arguments, store, capsys):
    assert main(["adopt", *arguments]) == 2
    assert capsys.readouterr().err.startswith("sphstudy: ")
