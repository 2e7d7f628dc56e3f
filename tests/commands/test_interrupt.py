"""Ctrl-C during a sweep: the prompt is back in two seconds, what is done is kept, nobody is left."""

import os
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


@pytest.mark.parametrize("to_group", [True, False], ids=["terminal", "parent only"])
def test_interrupt(tmp_path, to_group):
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "sphstudy",
            "-m",
            "scene=plate",
            "n=5,15",
            "h=1.5,1.7",
            "hydra.launcher.n_jobs=2",
        ],
        cwd=tmp_path,
        start_new_session=True,
        # Whatever runs the tests in the background may have told its children to ignore Ctrl-C.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        stderr=subprocess.PIPE,
        text=True,
    )
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
    deadline = time.monotonic() + 2.0
    while group(process.pid) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert group(process.pid) == []
    assert list(runs.glob(".writing-*")) == []
