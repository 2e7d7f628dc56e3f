"""Who computes a run: one of many at once, whoever finds a dead one's claim, and nobody else."""

import json
import multiprocessing
import os
import platform
import subprocess
import sys
import time

import psutil
import pytest

from sphstudy.store import lock
from sphstudy.store.lock import Claim, holder, is_alive


@pytest.fixture
def path(tmp_path):
    return tmp_path / "runs" / "run.running.json"


def written(path, **changes):
    """A claim of this process, changed."""
    Claim(path).take()
    note = json.loads(path.read_text()) | changes
    path.write_text(json.dumps(note))


def _compete(path, start, taken):
    start.wait()
    mine = Claim(path)
    if mine.take():
        taken.put(os.getpid())
        time.sleep(0.5)


def test_of_many_at_once_one_gets_the_run(path):
    fork = multiprocessing.get_context("fork")
    start, taken = fork.Event(), fork.SimpleQueue()
    many = [fork.Process(target=_compete, args=(path, start, taken)) for _ in range(12)]
    for one in many:
        one.start()
    start.set()
    for one in many:
        one.join(30)
    winner = taken.get()
    assert taken.empty()
    assert holder(path).process == winner


def test_a_claim_is_there_while_it_is_held_and_says_how_far_the_run_is(path, monkeypatch):
    monkeypatch.setattr(lock, "NOTE_INTERVAL", 0.0)
    mine = Claim(path)
    assert mine.take()
    with mine:
        assert is_alive(path)
        assert not Claim(path).take()
        mine.update(7, 20)
        note = holder(path)
        assert (note.step, note.steps, note.process) == (7, 20, os.getpid())
    assert not path.exists()
    assert not is_alive(path)


def test_a_claim_whose_process_was_killed_is_lost_and_taken_over(path):
    script = (
        "import os, signal; from pathlib import Path; from sphstudy.store.lock import Claim;"
        f"Claim(Path({str(path)!r})).take(); os.kill(os.getpid(), signal.SIGKILL)"
    )
    subprocess.run([sys.executable, "-c", script], check=False, timeout=60)
    assert holder(path) is not None
    assert not is_alive(path)
    assert Claim(path).take()
    assert holder(path).process == os.getpid()


def test_a_process_of_the_same_number_that_began_at_another_time_is_another(path):
    written(path)
    assert is_alive(path)
    written(path, born=1.0)
    assert not is_alive(path)


@pytest.mark.parametrize("born", ["", "52341", "?", None], ids=["gone", "ticks", "unknown", "none"])
def test_a_claim_of_an_older_version_cannot_be_judged_and_holds_nothing(path, born):
    """It counted in ticks of the kernel."""
    written(path, born=born)
    assert not is_alive(path)
    assert Claim(path).take()


def test_a_clock_that_is_set_makes_no_other_process(path, monkeypatch):
    written(path)
    boot, create = psutil.boot_time(), psutil.Process().create_time()
    monkeypatch.setattr(psutil, "boot_time", lambda: boot + 3600.0)
    monkeypatch.setattr(psutil.Process, "create_time", lambda self: create + 3600.0)
    assert is_alive(path)


def test_a_process_that_is_dead_but_not_waited_for_is_gone(path):
    child = subprocess.Popen(["true"])
    while lock._born(child.pid):
        time.sleep(0.01)
    assert child.returncode is None
    written(path, process=child.pid, born=0.0)
    assert not is_alive(path)
    child.wait()


@pytest.mark.parametrize(
    ("age", "alive"),
    [
        (0.0, True),
        (lock.LOST_AFTER / 2, True),
        (lock.LOST_AFTER + 1, False),
        (-lock.LOST_AFTER - 1, False),
    ],
    ids=["now", "a while ago", "long ago", "in the future, the clock was set back"],
)
def test_of_another_machine_the_last_sign_of_life_counts(path, age, alive):
    written(path, host=platform.node() + "2", process=1)
    then = time.time() - age
    os.utime(path, (then, then))
    assert is_alive(path) is alive
    assert Claim(path).take() is not alive


def test_a_holder_gives_signs_of_life_while_its_solver_is_busy(path, monkeypatch):
    monkeypatch.setattr(lock, "HEARTBEAT", 0.02)
    mine = Claim(path)
    mine.take()
    with mine:
        os.utime(path, (1.0, 1.0))
        deadline = time.monotonic() + 10
        while path.stat().st_mtime < 2.0:
            assert time.monotonic() < deadline
            time.sleep(0.01)


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"step": 1}', "null", "\0"])
def test_a_claim_that_cannot_be_read_holds_nothing(path, text):
    path.parent.mkdir()
    path.write_text(text)
    assert holder(path) is None
    assert not is_alive(path)
    assert Claim(path).take()


def test_a_claim_that_cannot_be_written_is_not_taken(path, monkeypatch):
    def full(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OSError, match="No space"):
        Claim(path).take()
    assert [file.name for file in path.parent.iterdir()] == [".claims"]
