"""What a job does on its node."""

import os
import signal
import time

import pytest

from sphstudy.running.slurm import node
from sphstudy.running.slurm.node import Batch, Note, read_note, work
from sphstudy.store.lock import ELSEWHERE


@pytest.fixture(autouse=True)
def signals():
    """As they were, after each test."""
    before = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, before)


def test_sigterm_ends_the_run_and_says_which_it_was(tmp_path):
    given_back = []

    def task(job):
        try:
            if job == 1:
                os.kill(os.getpid(), signal.SIGTERM)
                time.sleep(10.0)
        finally:
            given_back.append(job)

    batch = Batch(tmp_path, 7, task, [0, 1, 2])
    with pytest.raises(SystemExit) as end:
        work(batch)
    assert end.value.code == 143
    assert given_back == [0, 1]
    assert read_note(batch.note_path) == Note(at=1)


def test_what_runs_raise_is_noted(tmp_path):
    batch = Batch(tmp_path, 0, lambda job: 1 // job, [0, 1, 0])
    work(batch)
    message = "ZeroDivisionError: integer division or modulo by zero"
    assert read_note(batch.note_path) == Note(at=2, failures={0: message, 2: message})


@pytest.mark.parametrize("restarts", ["0", "1"])
def test_a_restarted_job_waits_for_the_claim_of_its_dead_self(tmp_path, monkeypatch, restarts):
    answers = [ELSEWHERE, ELSEWHERE, "done"]
    monkeypatch.setattr(node.time, "sleep", lambda seconds: None)
    monkeypatch.setenv("SLURM_RESTART_COUNT", restarts)
    work(Batch(tmp_path, 0, lambda job: answers.pop(0), [0]))
    assert answers == ([] if restarts == "1" else [ELSEWHERE, "done"])


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"at": "x", "failures": {}}', '{"at": 1, "failures": 2}']
)
def test_a_note_that_cannot_be_read_is_none(tmp_path, text):
    path = tmp_path / "note.json"
    path.write_text(text)
    assert read_note(path) == Note()
