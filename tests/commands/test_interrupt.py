"""Ctrl-C during a sweep: the prompt is back in two seconds, what is done is kept, nobody is left."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow


def group(leader):
    """Living processes of the leader's session, zombies apart."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session = path.read_text().rpartition(")")[2].split()[:4]
        except OSError:
            continue
        if int(session) == leader and state != "Z":
            found.append(path.parent.name)
    return found


def sweep(folder):
    """Two workers, busy for some seconds."""
    settings = ["scene=plate", "n=5,15", "h=1.5,1.7", "hydra.launcher.n_jobs=2"]
    return subprocess.Popen(
        [sys.executable, "-m", "sphstudy", "-m", *settings],
        cwd=folder,
        start_new_session=True,
        # Whatever runs the tests in the background may have told its children to ignore Ctrl-C.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def nobody_is_left(leader):
    """Waits two seconds at most."""
    deadline = time.monotonic() + 2.0
    while group(leader) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert group(leader) == []


@pytest.mark.parametrize("moment", range(6))
def test_at_any_moment_the_prompt_is_back(tmp_path, moment):
    """From the start of the interpreter on: before all is set up, while workers start, while they run."""
    process = sweep(tmp_path)
    time.sleep(random.Random(moment).uniform(0.0, 1.0) * (moment + 1))
    begun = time.monotonic()
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert time.monotonic() - begun < 2.0
    assert process.returncode in (130, -signal.SIGINT)
    # Before the program has begun, it is Python that answers.
    assert "Traceback" not in errors or "finished runs are kept" not in errors
    nobody_is_left(process.pid)
    runs = tmp_path / "results" / "runs"
    assert list(runs.glob(".writing-*")) == []
    assert not any("failed" in path.read_text() for path in runs.glob("*.log"))


@pytest.mark.parametrize("to_group", [True, False], ids=["terminal", "parent only"])
def test_interrupt(tmp_path, to_group):
    process = sweep(tmp_path)
    marker = time.monotonic() + 120
    runs = tmp_path / "results" / "runs"
    while not any('"step": 0' not in p.read_text() for p in runs.glob("*.running.json")):
        assert time.monotonic() < marker, "no run got under way"
        time.sleep(0.2)
    begun = time.monotonic()
    (os.killpg if to_group else os.kill)(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert time.monotonic() - begun < 2.0
    assert process.returncode == 130
    assert "finished runs are kept" in errors
    assert "Traceback" not in errors
    nobody_is_left(process.pid)
    assert not any("failed" in path.read_text() for path in runs.glob("*.log"))
    assert list(runs.glob(".writing-*")) == []
