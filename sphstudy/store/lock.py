"""Who computes a run: a file beside its record that only one process holds, and how far it has come.

<label>-<key>.running.json is made under a lock of the folder, so that of several sweeps over one store
one gets the run. A claim whose process is gone is *lost*: whoever wants the run takes it over. On the
same machine the table of processes shows that; on another the age of the file does, since the holder of a
claim touches it every few seconds.
"""

import fcntl
import json
import os
import platform
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path

import psutil

from sphstudy.store.atomic import replacing

ELSEWHERE = "elsewhere"
"""What a worker answers instead of an outcome if another process computes the run."""

NOTE_INTERVAL = 0.5
"""Seconds between two notes of the step reached."""

HEARTBEAT = 10.0
"""Seconds after which a holder touches its claim again, whatever its solver is busy with."""

LOST_AFTER = 120.0
"""Seconds without a sign of life, or into the future where a clock was set back, after which a claim of
another machine is lost.
"""

SAME_START = 0.1
"""By how much two readings of the time when one process started may differ (s)."""

_LOCK = ".claims"


@dataclass(frozen=True)
class Holder:
    """What a claim says.

    step, steps : the step reached, and how many there are; both 0 before the first.
    process, host : number of the process, and name of its machine.
    started : when the claim was taken (Unix time).
    born : when the process started (s after the machine did): numbers of processes are used again.
    """

    step: int
    steps: int
    process: int
    host: str
    started: float
    born: float = 0.0


class Claim:
    """The right to compute one run, as a context: taken by `take`, given back at the end."""

    def __init__(self, path: Path):
        self.path = path
        self._started, self._written = time.time(), 0.0
        self._over = threading.Event()

    def take(self) -> bool:
        """Takes the run unless a living process has it.

        Returns
        -------
        bool
            Whether the run is ours.

        Raises
        ------
        OSError
            If the claim cannot be written: without it, others would compute the run too.
        """
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with _locked(self.path.parent):
            if is_alive(self.path):
                return False
            self._write(0, 0)
        threading.Thread(target=self._beat, daemon=True).start()
        return True

    def __enter__(self) -> "Claim":
        return self

    def __exit__(self, *exception) -> None:
        self._over.set()
        self.path.unlink(missing_ok=True)

    def update(self, step: int, steps: int) -> None:
        """Notes the step reached, at most twice a second."""
        if time.monotonic() - self._written >= NOTE_INTERVAL:
            with suppress(OSError):
                self._write(step, steps)

    def _write(self, step: int, steps: int) -> None:
        self._written = time.monotonic()
        me = os.getpid()
        note = Holder(step, steps, me, platform.node(), self._started, _born(me))
        with replacing(self.path, durable=False) as temporary:
            temporary.write_text(json.dumps(asdict(note)))

    def _beat(self) -> None:
        while not self._over.wait(HEARTBEAT):
            with suppress(OSError):
                os.utime(self.path)


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    with open(folder / _LOCK, "a") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def remove_lost(claims: Iterable[Path]) -> None:
    """Removes those claims whose process is gone."""
    for path in claims:
        with _locked(path.parent), suppress(OSError):
            if not is_alive(path):
                path.unlink()


def holder(path: Path) -> Holder | None:
    """What a claim says, or None if there is none or it cannot be read."""
    # Most runs have none, and to ask is faster than to fail.
    if not os.path.isfile(path):
        return None
    try:
        values = json.loads(path.read_text())
        return Holder(**(values | {"born": float(values["born"])}))
    except (OSError, ValueError, TypeError, LookupError):
        return None


def is_alive(path: Path) -> bool:
    """Whether there is a claim whose process still runs; one that cannot be judged does not."""
    note = holder(path)
    if note is None:
        return False
    if note.host == platform.node():
        # A claim of an older version counts in ticks: no process has started then.
        born = _born(note.process)
        return born > 0.0 and abs(born - note.born) < SAME_START
    try:
        return abs(time.time() - path.stat().st_mtime) < LOST_AFTER
    except OSError:
        return False


def _born(process: int) -> float:
    """When a living process started (s after the machine did); 0 if it is gone, or a zombie."""
    try:
        found = psutil.Process(process)
        if found.status() == psutil.STATUS_ZOMBIE:
            return 0.0
        # Both are shifted where the clock is set, as after a pause of a virtual machine; this is not.
        return found.create_time() - psutil.boot_time()
    except (psutil.Error, ValueError, TypeError, OverflowError):
        return 0.0
