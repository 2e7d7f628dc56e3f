"""One point: whatever happens becomes a record with the reason, and nobody computes it twice."""

import contextlib
import pickle
import signal
import warnings
from dataclasses import replace

import numpy as np
import pytest

from sphstudy.running.one_run import TimedOut, compute, computed, give_up, run_job
from sphstudy.store.job import Job
from sphstudy.store.lock import ELSEWHERE, Claim
from sphstudy.store.store import Store
from tests.support.made_up import Solver, points


@pytest.fixture(scope="module")
def point():
    return points("n=5")[0]


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path)


@pytest.fixture
def solver(monkeypatch):
    return Solver(monkeypatch)


def test_a_run_leaves_a_record_and_a_log_and_no_claim(point, store, solver):
    assert compute(point.config, store, point.execution) == "done"
    assert store.status(point.config) == "done"
    assert not store.claim_path(point.config).exists()
    first, last = store.log_path(point.config).read_text().splitlines()
    assert "begun, numerics" in first
    assert last.endswith("done")


def test_what_another_sweep_has_done_meanwhile_is_not_computed_again(point, store, solver):
    compute(point.config, store, point.execution)
    assert compute(point.config, store, point.execution) == "done"
    assert solver.runs == [5]
    compute(point.config, store, point.execution, store.stamp(point.config))
    assert solver.runs == [5, 5], "asked for again by who knows the record"


def test_what_a_living_process_computes_is_left_to_it(point, store, solver):
    with Claim(store.claim_path(point.config)) as other:
        other.take()
        assert compute(point.config, store, point.execution) == ELSEWHERE
        assert store.status(point.config) == "running"
        with pytest.raises(RuntimeError, match="is being computed by another process"):
            computed(point.config, store, point.execution)
    assert solver.runs == []


def test_an_error_becomes_a_record_with_the_traceback_in_the_log(point, store, solver):
    def fails(*_):
        raise ZeroDivisionError("made for\nthis test")

    solver.deeds[5] = fails
    assert compute(point.config, store, point.execution) == "failed"
    assert store.summary(point.config).attributes["message"] == "ZeroDivisionError: made for"
    log = store.log_path(point.config).read_text()
    assert "Traceback" in log
    assert "in fails" in log


def test_what_a_compiler_makes_of_an_interrupt_is_no_result(point, store, solver):
    """llvmlite drops the KeyboardInterrupt, and misses what it was about to do."""

    def fails(*_):
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        raise RuntimeError("no compiled object yet")

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    solver.deeds[5] = fails
    try:
        with pytest.raises(KeyboardInterrupt):
            compute(point.config, store, point.execution)
    finally:
        signal.signal(signal.SIGINT, before)
    assert store.status(point.config) == "missing"
    assert "failed" not in store.log_path(point.config).read_text()


def test_a_run_ends_by_itself_when_its_time_is_over(point, store):
    execution = replace(point.execution, time_limit=1e-9)
    assert compute(point.config, store, execution) == "timeout"
    assert "(limit 1e-09 s)" in store.summary(point.config).attributes["message"]


def test_a_checkpoint_outlives_a_timeout_and_not_a_result(point, store, solver):
    kept = store.checkpoint_path(point.config)

    def late(*_):
        kept.write_text("")
        raise TimedOut("late")

    solver.deeds[5] = late
    assert compute(point.config, store, point.execution) == "timeout"
    assert kept.exists()
    solver.deeds.clear()
    assert compute(point.config, store, point.execution, store.stamp(point.config)) == "done"
    assert not kept.exists()


def test_memory_beyond_the_limit_ends_the_run_alone(point, store, solver):
    def greedy(*_):
        np.ones(2**33)

    solver.deeds[5] = greedy
    execution = replace(point.execution, memory_limit=16.0)
    assert compute(point.config, store, execution) == "failed"
    assert "MemoryError" in store.summary(point.config).attributes["message"]
    assert np.ones(10).sum() == 10


def test_warnings_go_to_the_log(point, store, solver, capsys):
    def warns(*_):
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.warn("made for this test", stacklevel=1)

    solver.deeds[5] = warns
    compute(point.config, store, point.execution)
    assert "made for this test" in store.log_path(point.config).read_text()
    assert capsys.readouterr().err == ""


def test_a_run_whose_process_is_gone_is_given_up_with_the_reason(point, store):
    Claim(store.claim_path(point.config)).take()
    give_up(point.config, store, "failed", "killed")
    assert store.status(point.config) == "failed"
    assert store.summary(point.config).attributes["message"] == "killed"
    assert "killed" in store.log_path(point.config).read_text()


def test_a_worker_makes_a_run_of_plain_values(point, store, solver):
    job = pickle.loads(pickle.dumps(Job.of(point, store)))
    assert run_job(job) == "done"
    assert store.summary(point.config).attributes["title"] == point.config.label
    assert job.is_recorded()
