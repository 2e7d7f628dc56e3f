"""A run that is killed goes on from its checkpoint and ends as if nothing had happened."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import xarray as xr

from sphstudy.store.checksum import seal

pytestmark = pytest.mark.slow

COMMAND = [sys.executable, "-m", "sphstudy", "scene=plate", "n=15", "h=1.5", "scene.periods=0.4"]


def record(folder):
    (path,) = (folder / "results" / "runs").glob("*.nc")
    with xr.open_dataset(path) as run:
        return run.load()


def test_a_killed_run_goes_on_and_is_the_uninterrupted_one(tmp_path):
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    whole.mkdir()
    killed.mkdir()
    subprocess.run(COMMAND, cwd=whole, check=True, capture_output=True, timeout=300)
    process = subprocess.Popen(
        [*COMMAND, "checkpoint=0.5"], cwd=killed, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
    )
    runs = killed / "results" / "runs"
    deadline = time.monotonic() + 120
    # A first one, of step 0, is taken where the set-up took longer than the interval.
    while not (found := [c for c in runs.glob("*.checkpoint") if int(np.load(c)["step"]) > 0]):
        assert process.poll() is None, "the run was over before its first checkpoint"
        assert time.monotonic() < deadline
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert not list(runs.glob("*.nc"))
    kept = dict(np.load(found[0]))
    assert int(kept["step"]) < int(record(whole)["steps"])
    # The CPU time that the killed process spent is counted: a mark to know the checkpoint by.
    kept["spent"] = np.array([1000.0, 1000.0])
    with open(found[0], "wb") as file:
        np.savez(file, **kept)
    seal(found[0], "")

    subprocess.run([*COMMAND, "checkpoint=0.5"], cwd=killed, check=True, capture_output=True, timeout=300)
    expected, resumed = record(whole), record(killed)
    assert not list(runs.glob("*.checkpoint"))
    assert float(resumed["steps"]) == float(expected["steps"])
    for name, variable in expected.data_vars.items():
        if variable.attrs.get("group") != "cost" and variable.dtype.kind in "fi":
            np.testing.assert_array_equal(resumed[name], variable, err_msg=str(name))
    assert float(resumed["cpu_seconds"]) > 1000.0
