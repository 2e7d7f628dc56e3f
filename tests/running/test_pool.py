"""Workers that die alone: the job is lost, by name and with the reason, and the others are done."""

import os
import signal
import threading
import time
from pathlib import Path

import pytest

from sphstudy.running import pool
from sphstudy.running.pool import Pool

pytestmark = pytest.mark.slow
"""Each worker is a fresh interpreter."""


def work(given):
    """What the job says; with a note that it was begun."""
    folder, name, deed = given
    with open(Path(folder, name), "a") as file:
        file.write(f"{os.getpid()}\n")
    if deed == "dies":
        os.kill(os.getpid(), signal.SIGKILL)
    elif deed == "ends":
        os._exit(3)
    elif deed == "sleeps":
        time.sleep(60)
    elif deed == "raises":
        raise ValueError("made for this test")
    elif deed == "full":
        raise OSError(28, "No space left on device")


@pytest.fixture
def done(tmp_path):
    def run(deeds, workers=2, limit=None):
        lost = {}
        jobs = [(str(tmp_path), name, deed) for name, deed in deeds.items()]
        Pool(workers).run(work, jobs, limit, lambda job, *why: lost.update({job[1]: why}))
        begun = {path.name: path.read_text().split() for path in tmp_path.iterdir()}
        return lost, begun

    return run


def test_each_death_costs_its_own_job_once_and_says_how(done):
    deeds = {"a": "", "b": "dies", "c": "", "d": "ends", "e": "raises", "f": "full", "g": "", "h": ""}
    lost, begun = done(deeds)
    assert set(begun) == set(deeds)
    assert all(len(times) == 1 for times in begun.values())
    assert set(lost) == {"b", "d", "e", "f"}
    assert lost["b"][0] == lost["d"][0] == "failed"
    assert "SIGKILL" in lost["b"][1]
    assert "EXIT(3)" in lost["d"][1]
    assert lost["e"] == ("failed", "ValueError: made for this test")
    assert lost["f"][0] == "interrupted"
    assert "No space left" in lost["f"][1]


def test_a_job_that_does_not_end_itself_is_ended_and_the_others_go_on(done, monkeypatch):
    monkeypatch.setattr(pool, "GRACE", 4.0)
    lost, begun = done({"a": "sleeps", "b": "", "c": ""}, workers=1, limit=0.1)
    assert list(lost) == ["a"]
    assert lost["a"][0] == "timeout"
    assert set(begun) == {"a", "b", "c"}
    (process,) = begun["a"]
    assert not alive(int(process))


def test_stop_leaves_no_worker_and_reports_no_loss(tmp_path):
    workers, lost = Pool(2), []
    jobs = [(str(tmp_path), name, "sleeps") for name in "abc"]
    thread = threading.Thread(target=workers.run, args=(work, jobs, None, lambda *why: lost.append(why)))
    thread.start()
    deadline = time.monotonic() + 60
    while len(list(tmp_path.iterdir())) < 2:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    workers.stop()
    thread.join(10)
    assert not thread.is_alive()
    processes = [int(line) for path in tmp_path.iterdir() for line in path.read_text().split()]
    deadline = time.monotonic() + 5
    while any(map(alive, processes)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(map(alive, processes))
    assert lost == []
    assert not (tmp_path / "c").exists()


def alive(process):
    """Whether it runs; a zombie does not."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
