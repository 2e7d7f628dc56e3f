"""What becomes of runs on a cluster, by what SLURM says of their jobs; the cluster is a fake."""

import os
import signal
import sys
import time
from dataclasses import replace

import pytest

from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.running.slurm import jobs
from sphstudy.running.slurm import settings as cluster_settings
from sphstudy.running.slurm.jobs import Slurm
from sphstudy.running.slurm.queries import UNKNOWN, State
from sphstudy.store.job import Job
from sphstudy.store.store import Store
from tests.running.slurm.fake import DONE, FakeCluster

SETTINGS = {
    "partition": None,
    "timeout_min": 60,
    "mem_gb": 2.0,
    "cpus_per_task": 1,
    "points_per_job": 1,
    "jobs_per_array": 1000,
    "array_parallelism": 256,
    "resubmissions": 1,
    "node_cache": True,
    "setup": [],
    "additional": [],
}
KILLED = State("FAILED", 137 << 8, "NonZeroExitCode")


@pytest.fixture(scope="module")
def points():
    """Six runs."""
    with session() as hydra:
        return hydra.points(["n=12,14,16", "h=1.3,1.5"], sweep=True)[0]


@pytest.fixture(autouse=True)
def commands(monkeypatch):
    """SLURM's commands are there; signals are as they were after each test."""
    monkeypatch.setattr(cluster_settings.shutil, "which", lambda name: name)
    monkeypatch.setattr(jobs.time, "sleep", lambda seconds: None)
    before = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, before)


class Sweep:
    """Six runs by way of a fake cluster; a run leaves its record unless it is told to raise."""

    def __init__(self, folder, points, monkeypatch, fake, raising=(), **settings):
        self.store, self.fake, self.points, self.raising = Store(folder), fake, points, set(raising)
        self.store.prepare()
        monkeypatch.setitem(sys.modules, "submitit", fake.submitit)
        for name in ("states", "cancel"):
            monkeypatch.setattr(jobs.queries, name, getattr(fake, name))
        monkeypatch.setattr(jobs.queries, "remembered", lambda job: State(UNKNOWN))
        self.jobs = [Job.of(p, self.store) for p in points]
        self.calls, self.lost = [], {}
        self.slurm = Slurm({**SETTINGS, **settings}, self.store.folder)

    def task(self, job):
        """The run."""
        number = self.jobs.index(job)
        self.calls.append(number)
        if number in self.raising:
            raise OSError("No space left on device")
        self.store.record_path(self.points[number].config).touch()
        return "done"

    def run(self, time_limit=None):
        """Until all is over; which runs have no record, with outcome and reason."""

        def lost(job, outcome, why):
            assert id(job) in map(id, self.jobs)
            self.lost[self.jobs.index(job)] = (outcome, why)

        self.slurm.run(self.task, self.jobs, time_limit, lost)
        return self.lost

    @property
    def left(self):
        """Files that the sweep leaves beside records."""
        return sorted(path.name for path in self.store.folder.glob("slurm/*/*"))


@pytest.fixture
def sweep(tmp_path, points, monkeypatch):
    """Makes a Sweep."""
    return lambda fake, *given, **settings: Sweep(tmp_path, points, monkeypatch, fake, *given, **settings)


def test_all_runs_are_done_and_nothing_is_left_behind(sweep):
    one = sweep(FakeCluster())
    assert one.run() == {}
    assert one.calls == [0, 1, 2, 3, 4, 5]
    assert not (one.store.folder / "slurm").exists()


def test_runs_are_dealt_out_to_jobs_and_jobs_to_arrays(sweep):
    one = sweep(FakeCluster(), points_per_job=2, jobs_per_array=2)
    assert one.run() == {}
    numbers = [[[one.jobs.index(job) for job in batch] for batch in array] for array in one.fake.arrays]
    assert numbers == [[[0, 3], [1, 4]], [[2, 5]]]


def test_what_sbatch_is_told(sweep):
    one = sweep(
        FakeCluster(),
        partition="short",
        cpus_per_task=3,
        mem_gb=0.5,
        points_per_job=2,
        setup=["module load python"],
        additional=["account=physics", "exclusive"],
    )
    one.run(time_limit=100.0)
    told = one.fake.parameters
    # Two runs of 100 s with a grace of 120 s each.
    assert told["time"] == 8
    assert told["mem"] == "512M"
    assert told["partition"] == "short"
    # No SIGUSR2, which submitit would ask for: it ends a Python that has not come to ignore it.
    assert told["additional_parameters"] == {
        "account": "physics",
        "exclusive": True,
        "requeue": True,
        "signal": "URG@1",
    }
    assert told["setup"][0] == "export NUMBA_NUM_THREADS=3"
    assert 'export XDG_CACHE_HOME="$cache"' in told["setup"]
    assert told["setup"][-1] == "module load python"


@pytest.mark.parametrize(("time_limit", "minutes"), [(None, 60), (1.0, 3), (1e6, 60)])
def test_a_job_gets_the_time_of_its_runs_and_some_grace(time_limit, minutes, monkeypatch):
    monkeypatch.setitem(sys.modules, "submitit", FakeCluster().submitit)
    assert cluster_settings.minutes(cluster_settings.settings_of(SETTINGS), time_limit) == minutes


def test_a_run_that_raises_costs_itself_only(sweep):
    one = sweep(FakeCluster(), [1], points_per_job=3)
    assert one.run() == {1: ("failed", "OSError: No space left on device")}
    assert sorted(one.calls) == [0, 1, 2, 3, 4, 5]


def test_a_killed_job_costs_the_run_at_work_only(sweep):
    one = sweep(FakeCluster(ends=[(1, KILLED)]), points_per_job=3)
    # The first job has runs 0, 2, 4: 0 is done, 2 is killed, 4 has not begun and is submitted again.
    assert one.run() == {2: ("failed", "SLURM job 1_0: FAILED (signal 9)")}
    assert one.calls == [0, 1, 3, 5, 4]
    assert "0.json" in one.left


def test_a_job_that_never_begins_costs_all_its_runs(sweep):
    one = sweep(FakeCluster(ends=[(None, State("FAILED", 1 << 8))]), points_per_job=3)
    assert one.run() == dict.fromkeys((0, 2, 4), ("failed", "SLURM job 1_0: FAILED (exit status 1)"))


def test_a_cancelled_job_is_not_submitted_again(sweep):
    one = sweep(FakeCluster(ends=[(1, State("CANCELLED"))]), points_per_job=3)
    assert one.run() == dict.fromkeys((2, 4), ("failed", "SLURM job 1_0: CANCELLED"))
    assert len(one.fake.arrays) == 1


@pytest.mark.parametrize("state", ["PREEMPTED", "NODE_FAIL", "BOOT_FAIL"])
def test_an_interrupted_job_is_submitted_again_so_many_times(sweep, state):
    one = sweep(FakeCluster(ends=[(0, State(state))]))
    assert one.run() == {}
    assert one.calls == [1, 2, 3, 4, 5, 0]


def test_and_not_more_often(sweep):
    ends = [(0, State("PREEMPTED")), *5 * [(1, DONE)], *2 * [(0, State("PREEMPTED"))]]
    one = sweep(FakeCluster(ends), resubmissions=2)
    assert one.run() == {0: ("failed", "SLURM job 3: PREEMPTED")}
    assert [len(array) for array in one.fake.arrays] == [6, 1, 1]


def test_a_run_that_has_the_whole_time_of_its_job_times_out(sweep):
    one = sweep(FakeCluster(ends=[(0, State("TIMEOUT", 0, "TimeLimit"))]))
    assert one.run() == {0: ("timeout", "SLURM job 1_0: TIMEOUT (TimeLimit)")}


def test_a_run_whose_time_others_had_used_up_gets_another_job(sweep):
    one = sweep(FakeCluster(ends=[(1, State("TIMEOUT"))]), points_per_job=3)
    assert one.run() == {}


@pytest.mark.parametrize("state", ["OUT_OF_MEMORY", "FAILED", "DEADLINE"])
def test_the_reason_names_the_state(sweep, state):
    outcome, why = sweep(FakeCluster(ends=[(0, State(state))])).run()[0]
    assert outcome == ("timeout" if state == "DEADLINE" else "failed")
    assert state in why


def test_want_of_memory_is_told_where_the_state_does_not_tell_it(sweep):
    # What SLURM 22.05 has reported: the step was killed, so the job has failed.
    said = "slurmstepd-node1: error: Detected 1 oom-kill event(s) in StepId=1.0.\n"
    one = sweep(FakeCluster(ends=[(0, State("FAILED", 1 << 8, "NonZeroExitCode"))], says={"1_0": said}))
    why = "SLURM job 1_0: FAILED (exit status 1): Detected 1 oom-kill event(s) in StepId=1.0."
    assert one.run() == {0: ("failed", why)}


def test_a_controller_that_does_not_answer_is_asked_again(sweep, monkeypatch, capsys):
    one = sweep(FakeCluster())
    answers = iter([None, None])
    monkeypatch.setattr(jobs.queries, "states", lambda name: next(answers, one.fake.states(name)))
    assert one.run() == {}
    assert capsys.readouterr().err.count("does not answer") == 1


def test_a_forgotten_job_has_failed_unless_its_records_are_there(sweep, monkeypatch):
    one = sweep(FakeCluster(ends=[(1, KILLED), (0, KILLED)]))
    monkeypatch.setattr(jobs.queries, "states", lambda name: {})
    assert one.run() == {1: ("failed", "SLURM job 1_1: UNKNOWN")}


def test_jobs_that_the_cluster_does_not_take_wait_for_others(sweep, capsys):
    one = sweep(FakeCluster(refuses=1), jobs_per_array=4)
    assert one.run() == {}
    assert [len(array) for array in one.fake.arrays] == [4, 2]
    assert "2 jobs wait until the cluster takes them" in capsys.readouterr().err


def test_a_cluster_that_takes_nothing_is_wrong_input(sweep):
    one = sweep(FakeCluster(refuses=0))
    with pytest.raises(ConfigurationError, match="QOSMaxSubmitJobPerUserLimit"):
        one.run()
    assert not (one.store.folder / "slurm").exists()


def test_a_run_of_another_sweep_is_left_to_it(sweep, monkeypatch):
    one = sweep(FakeCluster())
    monkeypatch.setattr(one, "task", lambda job: "elsewhere")
    monkeypatch.setattr(Job, "is_claimed", lambda job: True)
    assert one.run() == {}


def test_stopped_jobs_are_cancelled_and_those_just_submitted_do_nothing(sweep):
    one = sweep(FakeCluster())
    one.slurm._prepare()
    folder = one.store.folder / "slurm" / one.slurm.name
    one.slurm.stop()
    assert one.fake.cancelled == [one.slurm.name]
    one.fake.submit([jobs.Batch(folder, 0, one.task, one.jobs)])
    assert one.calls == []


def test_what_an_interrupted_sweep_left_goes_after_a_day(sweep):
    one = sweep(FakeCluster())
    for name, age in (("old", 90_000), ("new", 3_600)):
        marker = one.store.folder / "slurm" / name / "stopped"
        marker.parent.mkdir(parents=True)
        marker.touch()
        os.utime(marker, 2 * (time.time() - age,))
    one.run()
    assert [path.name for path in one.store.folder.glob("slurm/*")] == ["new"]


def test_more_threads_than_cores_are_refused(sweep):
    one = sweep(FakeCluster())
    many = replace(one.jobs[0], execution=replace(one.jobs[0].execution, threads=2))
    with pytest.raises(ConfigurationError, match="cpus_per_task"):
        one.slurm.run(one.task, [many], None, print)
    assert one.fake.arrays == []
