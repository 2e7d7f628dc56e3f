"""A cluster that consists of this process: what submitit and SLURM's commands do, as a test says."""

from contextlib import suppress
from dataclasses import replace
from types import SimpleNamespace

from sphstudy.running.slurm.node import work
from sphstudy.running.slurm.queries import State

DONE = State("COMPLETED")


class Killed(BaseException):
    """Ends a job in the middle of a run, as SIGKILL does."""


class FakeCluster:
    """`ends`: what becomes of the jobs in the order in which they are submitted, as (runs done before the
    end, State); those beyond are COMPLETED. `refuses`: so many submissions are accepted, then one is not.
    `says`: output of jobs, by id.
    """

    def __init__(self, ends=(), refuses=None, says=None):
        self.ends, self.refuses, self.says = list(ends), refuses, says or {}
        self.parameters, self.arrays, self.known, self.cancelled = {}, [], {}, []

    @property
    def submitit(self):
        """What `import submitit` finds."""
        cluster = self

        class SlurmExecutor:
            def __init__(self, folder):
                folder.mkdir(parents=True, exist_ok=True)

            def update_parameters(self, **parameters):
                cluster.parameters = parameters

            def map_array(self, function, batches):
                assert function is work
                return cluster.submit(batches)

        return SimpleNamespace(SlurmExecutor=SlurmExecutor)

    def submit(self, batches):
        """Runs a whole array at once."""
        if self.refuses == len(self.arrays):
            self.refuses = None
            raise RuntimeError("sbatch: error: QOSMaxSubmitJobPerUserLimit")
        number = len(self.arrays) + 1
        self.arrays.append([list(batch.jobs) for batch in batches])
        ids = [f"{number}_{i}" for i in range(len(batches))] if len(batches) > 1 else [str(number)]
        jobs = [SimpleNamespace(job_id=one) for one in ids]
        for job, batch in zip(jobs, batches, strict=True):
            runs, state = self.ends.pop(0) if self.ends else (len(batch.jobs), DONE)
            self.known[job.job_id] = state
            if said := self.says.get(job.job_id):
                (batch.folder / f"{job.job_id}_0_log.out").write_text(said)
            if runs is not None:
                self.carry_out(batch, runs)
        return jobs

    @staticmethod
    def carry_out(batch, runs):
        """The job on its node, which is killed in the run that follows so many."""
        left = [runs]

        def task(job):
            if not left[0]:
                raise Killed
            left[0] -= 1
            return batch.task(job)

        with suppress(Killed):
            work(replace(batch, task=task))

    def states(self, sweep):
        """What squeue answers."""
        return dict(self.known)

    def cancel(self, sweep):
        """What scancel is told."""
        self.cancelled.append(sweep)
