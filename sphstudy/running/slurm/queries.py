"""What SLURM says of jobs, and how they are cancelled: its commands, asked by the name of a sweep.

A name of its own for each sweep finds and cancels its jobs without a list of their numbers, even those
that were just being submitted. `squeue` knows a job for some minutes after its end (MinJobAge), and needs
no accounting database; `sacct` is asked of older ones, where there is one.
"""

import contextlib
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

FINAL = {
    "BOOT_FAIL",
    "CANCELLED",
    "COMPLETED",
    "DEADLINE",
    "FAILED",
    "NODE_FAIL",
    "OUT_OF_MEMORY",
    "PREEMPTED",
    "TIMEOUT",
}
"""States that a job does not leave. One that is requeued is PENDING again."""

UNKNOWN = "UNKNOWN"
"""State of a job that SLURM does not know any more."""

PATIENCE = 60.0
"""Seconds that a command may take: a controller that is busy answers late."""

_NO_MEMORY = re.compile(
    r"^(?:srun|slurmstepd)[^:]*: error: (.*(?:oom.kill|out of memory|memory limit).*)$", re.I | re.M
)

_FORMAT = "JobArrayID:60,State:30,exit_code:20,Reason:120"


@dataclass(frozen=True)
class State:
    """State of a job: its name, how the job ended (as wait(2) tells it), why it waits or has ended."""

    name: str
    status: int = 0
    reason: str = ""

    @property
    def final(self) -> bool:
        """Whether the job has ended for good."""
        return self.name in FINAL or self.name == UNKNOWN

    def __str__(self) -> str:
        signal, code = self.status & 127, self.status >> 8
        # A shell, and so a batch script, tells of a signal by 128 and its number.
        signal = signal or (code - 128 if code > 128 else 0)
        told = f"signal {signal}" if signal else f"exit status {code}" if code else ""
        reason = "" if self.reason in ("None", "NonZeroExitCode", "") else self.reason
        more = ", ".join(part for part in (told, reason) if part)
        return f"{self.name} ({more})" if more else self.name


def states(sweep: str) -> dict[str, State] | None:
    """States of all jobs of this name that SLURM knows, by id (12 or 12_3); None without an answer."""
    said = _asked(
        ["squeue", "--noheader", "--array", "--states=all", f"--name={sweep}", f"--Format={_FORMAT}"]
    )
    return None if said is None else dict(_read(line) for line in said.splitlines() if line.strip())


def _read(line: str) -> tuple[str, State]:
    identity, name, status, *reason = line.split(maxsplit=3)
    return identity, State(name, int(status), "".join(reason).strip())


def remembered(job: str) -> State:
    """State of a job that squeue has forgotten, from the accounting database; UNKNOWN without one."""
    said = _asked(
        ["sacct", "--allocations", "--noheader", "--parsable2", "--format=State", f"--jobs={job}"]
    )
    # "CANCELLED by 1000", of which the first word is the state.
    words = (said or "").split()
    return State(words[0] if words else UNKNOWN)


def memory_complaint(output: Path) -> str:
    """What SLURM has written into a job's output if it was killed for want of memory, otherwise "".

    The state does not tell: where only the step that `srun` has started is killed, the job has FAILED.
    """
    try:
        found = _NO_MEMORY.search(output.read_text(errors="replace"))
    except OSError:
        return ""
    return found.group(1) if found else ""


def cancel(sweep: str) -> None:
    """Cancels all jobs of this name, running or waiting; waits a second at most, the command goes on."""
    with contextlib.suppress(OSError, subprocess.TimeoutExpired):
        # In a session of its own: a second Ctrl-C must not end it.
        subprocess.Popen(
            ["scancel", f"--name={sweep}"], start_new_session=True, stderr=subprocess.DEVNULL
        ).wait(1.0)


def _asked(command: list[str]) -> str | None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout if done.returncode == 0 else None
