"""Runs as jobs of a SLURM cluster, in arrays, submitted by submitit.

What became of a run is read from its record, from SLURM's state of its job, and from the job's note
(node.py). submitit hands functions over as pickles in a folder of the sweep, which is
<results>/slurm/<name>, and leaves there one with the function's value (None), which is never read.

A job that is killed and put back into the queue goes on from the checkpoint of its run. SLURM does that
itself when a node fails or a job is preempted; where it does not, the job is submitted again.
"""

import math
import shutil
import sys
import time
import uuid
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from sphstudy.errors import ConfigurationError
from sphstudy.running.slurm import queries
from sphstudy.running.slurm.node import STOPPED, Batch, Note, read_note, work
from sphstudy.running.slurm.settings import executor, settings_of
from sphstudy.store.job import Job

INTERRUPTED = ("BOOT_FAIL", "NODE_FAIL", "PREEMPTED")
"""Final states that say nothing against the run."""

_USUAL = {"None", "Priority", "Resources", "JobArrayTaskLimit", "BeginTime", "Cleaning"}

LONGEST_PAUSE = 30.0
"""Seconds between two questions to SLURM, at most."""

VISIBLE_AFTER = 60.0
"""Seconds after which a file that a node has written is seen here at the latest: NFS keeps folders in
mind for so long.
"""


class Slurm:
    """Jobs of one sweep; `folder`: the results, which all nodes see."""

    def __init__(self, settings: dict[str, Any], folder: Path):
        self._settings = settings_of(settings)
        self.name = f"sphstudy-{uuid.uuid4().hex[:8]}"
        self._folder = folder.resolve() / "slurm" / self.name
        self._submitted, self._bad = 0, 0
        self._tries: Counter[int] = Counter()
        self._said: set[str] = set()

    def run(
        self,
        task: Callable[[Any], Any],
        jobs: list[Job],
        time_limit: float | None,
        lost: Callable[[Any, str, str], None],
    ) -> None:
        """Calls task(job) for each job on a node, and waits for all; see launching.Workers.

        Raises ConfigurationError if nothing can be submitted.
        """
        self._check(jobs)
        self._prepare()
        waiting, refused, at_work = list(jobs), False, dict[str, Batch]()
        while waiting or at_work:
            if waiting and not refused:
                waiting = self._submit(task, waiting, time_limit, at_work)
                refused = bool(waiting)
            ended = self._ended(at_work)
            refused = refused and not ended
            for job_id, state in ended.items():
                waiting += self._again(job_id, at_work.pop(job_id), state, lost)
        self._tidy()

    def stop(self) -> None:
        """Cancels all jobs; one that SLURM is just being given ends itself."""
        with suppress(OSError):
            (self._folder / STOPPED).touch()
        queries.cancel(self.name)

    def _check(self, jobs: list[Job]) -> None:
        cores = self._settings.cpus_per_task
        threads = max(job.execution.threads for job in jobs)
        if threads > cores:
            raise ConfigurationError(
                [f"threads={threads}: a job has {cores} cores (hydra.launcher.cpus_per_task)"]
            )
        if "%" in str(self._folder):
            raise ConfigurationError(
                [f"{self._folder}: SLURM takes % in the name of a folder for its own"]
            )

    def _prepare(self) -> None:
        """Makes the sweep's folder, and removes those of sweeps that were interrupted a day ago."""
        for path in self._folder.parent.glob(f"*/{STOPPED}"):
            if path.stat().st_mtime < time.time() - 86400.0:
                shutil.rmtree(path.parent, ignore_errors=True)
        # Nodes load code from there: nobody else is to put any.
        self._folder.mkdir(mode=0o700, parents=True)

    def _submit(self, task, waiting: list[Job], time_limit: float | None, at_work: dict) -> list[Job]:
        """Submits jobs, and adds them to those at work; returns what the cluster does not take by now."""
        batches, size = self._batches(task, waiting), self._settings.jobs_per_array
        submitting = executor(self._settings, self._folder, self.name, time_limit)
        for first in range(0, len(batches), size):
            array = batches[first : first + size]
            try:
                numbers = [job.job_id for job in submitting.map_array(work, array)]
            except (OSError, RuntimeError) as error:
                if not at_work:
                    self._tidy()
                    why = str(error).strip().splitlines()[-1]
                    raise ConfigurationError([f"hydra/launcher=slurm: not submitted: {why}"]) from None
                self._say(f"{len(batches) - first} jobs wait until the cluster takes them: {error}")
                return [job for batch in batches[first:] for job in batch.jobs]
            at_work |= zip(numbers, array, strict=True)
            number = numbers[0].split("_")[0]
            self._say(f"{len(array)} jobs submitted as {number} (scancel --name={self.name} ends all)")
        return []

    def _batches(self, task, jobs: list[Job]) -> list[Batch]:
        """Longest runs come first in `jobs`: dealt out in turn, every job gets some of them."""
        many = math.ceil(len(jobs) / self._settings.points_per_job)
        first, again = self._submitted, self._submitted > 0
        self._submitted += many
        return [Batch(self._folder, first + i, task, jobs[i::many], again) for i in range(many)]

    def _ended(self, at_work: dict[str, Batch]) -> dict[str, queries.State]:
        """Waits for a while, and tells which jobs have ended, and how."""
        begun = time.monotonic()
        known = queries.states(self.name)
        # At most a twentieth of the time the controller is busy with these questions.
        pause = min(LONGEST_PAUSE, max(1.0, 20.0 * (time.monotonic() - begun)))
        ended = {}
        if known is None:
            self._say("SLURM does not answer: asked again until it does")
        else:
            for state in known.values():
                if state.name == "PENDING" and state.reason not in _USUAL:
                    self._say(f"SLURM lets jobs wait: {state.reason}")
            found = {one: known[one] if one in known else queries.remembered(one) for one in at_work}
            ended = {one: state for one, state in found.items() if state.final}
        if not ended:
            time.sleep(pause)
        return ended

    def _again(self, job_id: str, batch: Batch, state: queries.State, lost) -> list[Job]:
        """Looks what became of a job's runs, tells which are lost, and returns which to submit again."""
        if state.name == "COMPLETED":
            self._see(batch)
        else:
            self._bad += 1
        note, again = read_note(batch.note_path), []
        for at, job in enumerate(batch.jobs):
            if job.is_recorded():
                continue
            if at in note.failures:
                lost(job, "failed", note.failures[at])
            elif state.name == "COMPLETED" or (note.at is not None and at < note.at):
                continue  # Another sweep is computing it.
            elif self._not_begun(note, at, state) or self._may_try_again(job, state, at):
                again.append(job)
            else:
                outcome = "timeout" if state.name in ("TIMEOUT", "DEADLINE") else "failed"
                lost(job, outcome, f"SLURM job {job_id}: {self._told(job_id, state)}")
        return again

    def _told(self, job_id: str, state: queries.State) -> str:
        """How a job ended; if it was for want of memory, in SLURM's words."""
        # submitit's name for the output of a job's only task.
        complaint = queries.memory_complaint(self._folder / f"{job_id}_0_log.out")
        return f"{state}: {complaint}" if complaint else str(state)

    def _not_begun(self, note: Note, at: int, state: queries.State) -> bool:
        """Whether the job ended while it was at an earlier run, and not because somebody wanted it to."""
        return note.at is not None and at > note.at and state.name != "CANCELLED"

    def _may_try_again(self, job, state: queries.State, at: int) -> bool:
        """Whether a run had bad luck: a job interrupted, or one whose time others had used up."""
        if state.name not in INTERRUPTED and not (state.name == "TIMEOUT" and at > 0):
            return False
        self._tries[id(job)] += 1
        return self._tries[id(job)] <= self._settings.resubmissions

    def _see(self, batch: Batch) -> None:
        """Waits until what a job has written is seen here."""
        deadline = time.monotonic() + VISIBLE_AFTER
        while time.monotonic() < deadline:
            # As submitit does: a change of a folder makes NFS look again.
            with suppress(OSError):
                runs = self._folder.parents[1] / "runs"
                runs.chmod(runs.stat().st_mode)
            note = read_note(batch.note_path)
            if all(
                job.is_recorded() or job.is_claimed() or at in note.failures
                for at, job in enumerate(batch.jobs)
            ):
                return
            time.sleep(1.0)

    def _say(self, text: str) -> None:
        """Tells once."""
        if text not in self._said:
            self._said.add(text)
            print(text, file=sys.stderr)

    def _tidy(self) -> None:
        """Removes the sweep's folder; the jobs' output stays if one of them went wrong."""
        if not self._bad:
            shutil.rmtree(self._folder, ignore_errors=True)
            with suppress(OSError):
                self._folder.parent.rmdir()
        for path in self._folder.glob("*.pkl"):
            path.unlink(missing_ok=True)
