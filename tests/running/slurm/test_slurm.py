"""What SLURM's commands say."""

import pytest

from sphstudy.running.slurm import queries
from sphstudy.running.slurm.queries import State

SQUEUE = """\
2_2                 COMPLETED           0                   None
2_0                 FAILED              35072               NonZeroExitCode
2_1                 FAILED              768                 NonZeroExitCode
3                   PENDING             0                   launch failed requeued held
"""


@pytest.fixture
def command(tmp_path, monkeypatch):
    """Puts a command that prints something, and ends with some status, on the path."""
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")

    def make(name, text, status=0):
        path = tmp_path / name
        path.write_text(f'#!/bin/sh\necho "$@" >{tmp_path}/asked\ncat <<END\n{text}END\nexit {status}\n')
        path.chmod(0o755)
        return tmp_path / "asked"

    return make


def test_states_are_asked_for_by_the_name_of_the_sweep(command):
    asked = command("squeue", SQUEUE)
    found = queries.states("sphstudy-1")
    assert "--name=sphstudy-1" in asked.read_text()
    assert found == {
        "2_2": State("COMPLETED", 0, "None"),
        "2_0": State("FAILED", 35072, "NonZeroExitCode"),
        "2_1": State("FAILED", 768, "NonZeroExitCode"),
        "3": State("PENDING", 0, "launch failed requeued held"),
    }
    assert [state.final for state in found.values()] == [True, True, True, False]
    assert str(found["2_0"]) == "FAILED (signal 9)"
    assert str(found["2_1"]) == "FAILED (exit status 3)"
    assert str(State("OUT_OF_MEMORY", 9, "OutOfMemory")) == "OUT_OF_MEMORY (signal 9, OutOfMemory)"


def test_no_answer_is_no_state(command):
    command("squeue", "slurm_load_jobs error: Unable to contact slurm controller\n", status=1)
    assert queries.states("sphstudy-1") is None


def test_a_forgotten_job_is_looked_up_where_there_are_accounts(command):
    command("sacct", "CANCELLED by 1000\n")
    assert queries.remembered("2_1") == State("CANCELLED")
    command("sacct", "", status=1)
    assert queries.remembered("2_1") == State("UNKNOWN")
    assert queries.remembered("2_1").final


@pytest.mark.parametrize(
    "said",
    [
        "StepId=1.0 exceeded memory limit (433172480 > 104857600), being killed",
        "Detected 1 oom-kill event(s) in StepId=1.0. Some of your processes may have been killed",
    ],
)
def test_want_of_memory_is_read_from_the_output(tmp_path, said):
    path = tmp_path / "output"
    path.write_text(f"slurm: memory limit\nslurmstepd-node2: error: {said}\nsrun: error: Killed\n")
    assert queries.memory_complaint(path) == said


def test_other_ends_are_no_want_of_memory(tmp_path):
    path = tmp_path / "output"
    assert queries.memory_complaint(path) == ""
    path.write_text("error: out of memory\nslurmstepd: error: *** STEP 1.0 CANCELLED DUE TO TIME LIMIT\n")
    assert queries.memory_complaint(path) == ""


def test_a_sweep_is_cancelled_by_its_name(command):
    asked = command("scancel", "")
    queries.cancel("sphstudy-1")
    assert asked.read_text() == "--name=sphstudy-1\n"
