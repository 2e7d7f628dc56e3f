"""What a job of a cluster does on its node: its runs, one after the other, and a note of its progress."""

import json
import os
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sphstudy.store.atomic import replacing
from sphstudy.store.lock import ELSEWHERE, HEARTBEAT, LOST_AFTER

STOPPED = "stopped"
"""A file of this name in the sweep's folder ends jobs that begin, and others before their next run."""


@dataclass(frozen=True)
class Batch:
    """The runs of one job: task(job) for each of `jobs`.

    `folder`: of the sweep, shared by all nodes; `number`: of the job in the sweep; `again`: whether a run
    may have been begun by a job that is gone.
    """

    folder: Path
    number: int
    task: Callable[[Any], Any]
    jobs: list[Any]
    again: bool = False

    @property
    def note_path(self) -> Path:
        """Where the job keeps its note."""
        return self.folder / f"{self.number}.json"


@dataclass
class Note:
    """How far a job is: the number of the run it has begun last, None before the first, and what its runs
    raised, by number.
    """

    at: int | None = None
    failures: dict[int, str] = field(default_factory=dict)

    def write(self, path: Path) -> None:
        """Writes the note, whole or not at all; a disk that is full costs the note, not the run."""
        with suppress(OSError), replacing(path, durable=False) as temporary:
            temporary.write_text(json.dumps({"at": self.at, "failures": self.failures}))


def read_note(path: Path) -> Note:
    """The note of a job, or that of one that has not begun if there is none that can be read."""
    try:
        values = json.loads(path.read_text())
        at, failures = values["at"], values["failures"]
        return Note(None if at is None else int(at), {int(k): str(v) for k, v in failures.items()})
    except (OSError, ValueError, TypeError, LookupError, AttributeError):
        return Note()


def work(batch: Batch) -> None:
    """Does the runs of a job. What a run raises is noted, and the others go on."""
    _listen()
    begun_before = batch.again or int(os.environ.get("SLURM_RESTART_COUNT", "0")) > 0
    note = Note()
    for at, job in enumerate(batch.jobs):
        if (batch.folder / STOPPED).exists():
            return
        note.at = at
        note.write(batch.note_path)
        try:
            _do(batch.task, job, begun_before)
        except Exception as error:
            note.failures[at] = f"{type(error).__name__}: {error}"
            note.write(batch.note_path)


def _do(task: Callable[[Any], Any], job: Any, begun_before: bool) -> None:
    """A run; where one was begun before, waits until the claim of a node that is gone counts as lost."""
    deadline = time.monotonic() + LOST_AFTER + HEARTBEAT
    while task(job) == ELSEWHERE and begun_before and time.monotonic() < deadline:
        time.sleep(HEARTBEAT)


def _listen() -> None:
    """SIGTERM, before SLURM kills a job, ends it so that its claim is given back at once."""

    def leave(number, frame):
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        raise SystemExit(128 + number)

    signal.signal(signal.SIGTERM, leave)
