"""Kills (-9) at random moments of sweeps and of single runs, and whether anybody loses anything.

`python -m tests.stress.kills 100` kills so often and prints its figures. After every kill each finished
record is still the file that it was, and no file that cannot be read counts as a record; at the end the
dataset and all records are those of an uninterrupted sweep, but for costs and dates.
"""

import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr

from sphstudy.analysis.points_table import ORIGIN
from sphstudy.store.netcdf import read_dataset
from sphstudy.store.store import read

PLATE = ("scene=plate", "method=tl", "scene.periods=0.01")
SWEEP = ("-m", *PLATE, "n=5,7", "h=1.3,1.4", "hydra.launcher.n_jobs=2")
LONG = ("scene=plate", "method=tl", "n=15", "h=1.3", "scene.periods=0.6", "checkpoint=0.1")
"""A single run of about two seconds that takes a checkpoint ten times a second."""

KINDS = ("group", "parent", "worker", "single")
"""Of a sweep the whole process group, its parent only, or one worker only; a single long run."""

COSTS = ("cpu_seconds", "wall_seconds", "compile_seconds", "peak_memory")
"""What two runs of the same numbers do not have in common."""

RESTARTS = 5
"""Kills one after the other before a sweep is left to finish."""


def command(arguments: tuple[str, ...], folder: Path) -> subprocess.Popen:
    """The program, in a session of its own, with its words in a file."""
    with open(folder / "said.txt", "ab") as said:
        return subprocess.Popen(
            [sys.executable, "-m", "sphstudy", *arguments, f"results={folder}"],
            start_new_session=True,
            stdout=said,
            stderr=said,
        )


def finished(folder: Path) -> dict[str, str]:
    """Every record, with a digest of its bytes."""
    return {path.name: _digest(path) for path in (folder / "runs").glob("[!.]*.nc")}


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def processes(session: int) -> dict[int, str]:
    """Living processes of a session, each with its command."""
    found = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, own = path.read_text().rpartition(")")[2].split()[:4]
            if int(own) == session and state != "Z":
                found[int(path.parent.name)] = (path.parent / "cmdline").read_text()
        except OSError:
            continue
    return found


def end(process: subprocess.Popen) -> None:
    """Nobody of the session is left."""
    for _ in range(50):
        for one in processes(process.pid):
            try:
                os.kill(one, signal.SIGKILL)
            except ProcessLookupError:
                continue
        if process.poll() is not None and not processes(process.pid):
            return
        time.sleep(0.05)


class Reference:
    """The same sweep or run, not interrupted: its dataset, its records, how long it took."""

    def __init__(self, arguments: tuple[str, ...], folder: Path):
        folder.mkdir()
        # Twice: kills are to come while runs go on, and the first sweep may have had to compile.
        for again in ((), ("--force",)):
            begun = time.monotonic()
            assert command((*arguments, *again), folder).wait() == 0, (folder / "said.txt").read_text()
        self.seconds = time.monotonic() - begun
        self.contents = contents(folder)


def contents(folder: Path) -> dict[str, str]:
    """The combined dataset and every record, each as a digest of what interruptions must not change."""
    found = {path.name: read(path) for path in sorted((folder / "runs").glob("[!.]*.nc"))}
    found |= {path.name: read_dataset(str(path), folder) for path in (folder / "sweeps").glob("[!.]*.nc")}
    return {name: _lasting(dataset) for name, dataset in found.items() if dataset is not None}


def _lasting(dataset: xr.Dataset) -> str:
    """A digest of all numbers and texts to the last bit, without costs, dates and places."""
    digest = hashlib.sha256()
    for name in sorted(map(str, dataset.variables)):
        variable = dataset.variables[name]
        if name in COSTS:
            continue
        values = variable.values
        data = values.tobytes() if values.dtype != object else json.dumps(values.tolist()).encode()
        digest.update(f"{name} {variable.dims} {values.shape} {values.dtype}".encode() + data)
    own = {k: v for k, v in dataset.attrs.items() if k not in (*ORIGIN, "threads")}
    digest.update(json.dumps(own, sort_keys=True, default=np.ndarray.tolist).encode())
    return digest.hexdigest()


def kill(kind: str, process: subprocess.Popen, dice: random.Random) -> bool:
    """Kills what the kind says; whether there was anybody to kill."""
    if kind == "worker":
        workers = [p for p, line in processes(process.pid).items() if "popen_loky" in line]
        victims = [dice.choice(workers)] if workers else []
    else:
        victims = [process.pid] if kind == "parent" else list(processes(process.pid))
    if process.poll() is not None or not victims:
        return False
    for victim in victims:
        try:
            os.kill(victim, signal.SIGKILL)
        except ProcessLookupError:
            continue
    return True


class Trial:
    """One sweep or run, killed several times and then left to finish."""

    def __init__(self, kind: str, reference: Reference, folder: Path, dice: random.Random):
        self.kind, self.reference, self.folder, self.dice = kind, reference, folder, dice
        self.arguments = LONG if kind == "single" else SWEEP
        self.found: Counter[str] = Counter()
        folder.mkdir()

    def go(self, kills: int) -> Counter[str]:
        """Kills so often at most, finishes, compares. Counts kills and what was wrong."""
        for _ in range(kills):
            before = finished(self.folder)
            process = command(self.arguments, self.folder)
            time.sleep(self.dice.uniform(0.0, self.reference.seconds))
            self.found["kills"] += kill(self.kind, process, self.dice)
            # A sweep goes on without its worker. Workers without their parent may finish what they have
            # begun, beside those of the next parent.
            process.wait()
            self._look(before)
        begun = command((*self.arguments, "retry=failed"), self.folder)
        self.found["unfinished"] += begun.wait() != 0
        end(begun)
        self.found["different"] += contents(self.folder) != self.reference.contents
        self.found["set aside"] += len(list((self.folder / "runs").glob("*.unreadable")))
        return self.found

    def _look(self, before: dict[str, str]) -> None:
        """Nothing that was done is lost, and what looks like a record is one."""
        after = finished(self.folder)
        lost = {name for name, digest in before.items() if after.get(name) != digest}
        # A record of a worker that was killed is one, and may be replaced: it is tried again.
        self.found["lost"] += len(lost)
        for name in after:
            path = self.folder / "runs" / name
            self.found["unreadable"] += path.exists() and read(path) is None


def campaign(kills: int, seed: int) -> Counter[str]:
    """Trials of each kind in turn until there were so many kills."""
    dice, total = random.Random(seed), Counter()
    with tempfile.TemporaryDirectory() as name:
        whole = {
            arguments: Reference(arguments, Path(name, f"whole-{len(arguments)}"))
            for arguments in (SWEEP, LONG)
        }
        trial = 0
        while total["kills"] < kills:
            kind = KINDS[trial % len(KINDS)]
            reference = whole[LONG if kind == "single" else SWEEP]
            one = Trial(kind, reference, Path(name, f"trial-{trial}"), dice)
            found = one.go(min(RESTARTS, kills - total["kills"]))
            total += Counter({**found, f"kills of {kind}": found["kills"], "trials": 1})
            trial += 1
            print(f"trial {trial}: {found['kills']} kills of {kind}", file=sys.stderr)
            if any(found[wrong] for wrong in WRONG):
                said = (one.folder / "said.txt").read_text(errors="replace")
                print(f"trial {trial}, {kind}: {dict(found)}\n{said}", file=sys.stderr)
    return total


WRONG = ("unfinished", "different", "set aside", "lost", "unreadable")
"""What must not be."""


if __name__ == "__main__":
    start = time.monotonic()
    figures = campaign(*(int(a) for a in (sys.argv[1:] + ["100", "1"][len(sys.argv) - 1 :])))
    for figure in ("trials", "kills", *(f"kills of {kind}" for kind in KINDS), *WRONG):
        print(f"{figure}: {figures[figure]}")
    print(f"{time.monotonic() - start:.0f} s")
    sys.exit(any(figures[wrong] for wrong in WRONG))
