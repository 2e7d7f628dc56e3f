"""Output that nobody takes: a pipe whose reader is gone, a disk that is full, no output at all."""

import os
import subprocess
import sys

import pytest

from sphstudy.store.record import STATUS
from sphstudy.store.store import read

COMMANDS = [["--help"], ["list"], ["describe", "scene", "plate"]]
BUFFERED = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
"""An environment in which output is written late, as it is for users."""
SWEEP = ["-m", "scene=plate", "scene.periods=0.1", "n=5", "h=1.5,1.7", "hydra/launcher=basic"]


@pytest.fixture
def unread():
    """The writing end of a pipe that nobody reads."""
    reading, writing = os.pipe()
    os.close(reading)
    yield writing
    os.close(writing)


def program(folder, arguments, **streams):
    """The program's exit status, and what it had to complain of."""
    command = [sys.executable, "-m", "sphstudy", *arguments]
    streams = {"stderr": subprocess.PIPE, **streams}
    ended = subprocess.run(command, cwd=folder, env=BUFFERED, text=True, timeout=120, **streams)
    return ended.returncode, ended.stderr


@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_without_a_reader_it_ends_quietly(tmp_path, unread, arguments):
    assert program(tmp_path, arguments, stdout=unread) == (141, "")


def test_with_a_reader_that_leaves_after_a_line(tmp_path):
    command = [sys.executable, "-m", "sphstudy", "list"]
    process = subprocess.Popen(
        command, cwd=tmp_path, env=BUFFERED, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout.readline() == b"scene:\n"
    process.stdout.close()
    assert process.stderr.read() == b""
    process.stderr.close()
    assert process.wait(60) in (0, 141), "0 if all was in the pipe by then"


def test_complaints_without_a_reader(tmp_path, unread):
    assert program(tmp_path, ["h=-1"], stdout=unread, stderr=subprocess.STDOUT)[0] == 141


def test_runs_are_kept_when_nobody_reads_their_table(tmp_path, unread):
    status, errors = program(tmp_path, SWEEP, stdout=unread)
    assert status == 141
    assert "Traceback" not in errors
    runs = [read(path) for path in (tmp_path / "results" / "runs").glob("*.nc")]
    assert [STATUS[int(run["status"])] for run in runs] == ["done", "done"]
    assert len(list((tmp_path / "results" / "sweeps").glob("*.nc"))) == 1


@pytest.mark.parametrize("arguments", [["--help"], ["list"]], ids=" ".join)
def test_a_full_disk_is_told_in_a_line(tmp_path, arguments):
    with open("/dev/full", "w") as full:
        status, errors = program(tmp_path, arguments, stdout=full)
    assert status == 1
    assert errors == "sphstudy: [Errno 28] No space left on device; finished runs are kept\n"


def test_without_any_output(tmp_path):
    shell = ["sh", "-c", '"$0" -m sphstudy list >&-', sys.executable]
    ended = subprocess.run(shell, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert (ended.returncode, ended.stderr) == (0, "")
