"""The mode I grid through a real SLURM, with kills, compared bit for bit with a local run."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import xarray as xr

from sphstudy import slurm

GRIDS = {
    "small": ["h=1.3,1.5,1.7,1.9", "n=20,24"],
    "thesis": ["h=1.3,1.5,1.7,1.9", "n=40,50,60"],
}
CLUSTER = "hydra/launcher=slurm"
PROGRESS = re.compile(r"\d+ of \d+ runs done|^\[\d+/\d+\]|^ |^dataset|^$")


class Trial:
    """One grid, one folder for each way of running it."""

    def __init__(self, folder: Path, grid: str):
        self.folder, self.grid = folder, GRIDS[grid]
        self.wrong: list[str] = []

    def sweep(self, name: str, *more: str, meanwhile=None, expected: int = 0, grid=None) -> None:
        """Runs a sweep to its end, records in `name`, and `meanwhile(process, runs)` beside it."""
        given = ["-m", *(grid or self.grid), f"results={self.folder / name}", *more]
        print(f"$ sphstudy {' '.join(given)}")
        begun = time.monotonic()
        with open(self.folder / "said", "w+") as said:
            command = [sys.executable, "-m", "sphstudy", *given]
            process = subprocess.Popen(command, cwd=self.folder, stdout=said, stderr=said, text=True)
            try:
                if meanwhile is not None:
                    meanwhile(process, self.folder / name / "runs")
                status = process.wait()
            except BaseException:
                process.terminate()
                raise
            said.seek(0)
            for line in said:
                if not PROGRESS.search(line):
                    print(f"  {line.rstrip()}")
        print(f"  exit status {status} after {time.monotonic() - begun:.1f} s")
        self.check(status == expected, f"{name}: exit status {status}, not {expected}")

    def check(self, holds: bool, complaint: str) -> None:
        """Notes what does not hold."""
        if not holds:
            self.wrong.append(complaint)
            print(f"  WRONG: {complaint}")

    def compare(self, name: str) -> None:
        """Every record against that of the local run: all variables but costs, bit for bit."""
        local = {path.name: path for path in (self.folder / "local" / "runs").glob("*.nc")}
        found = {path.name: path for path in (self.folder / name / "runs").glob("*.nc")}
        self.check(local.keys() == found.keys(), f"{name}: not the same records")
        variables, differing = 0, []
        for record in sorted(local.keys() & found.keys()):
            with xr.open_dataset(local[record]) as one, xr.open_dataset(found[record]) as other:
                kept = [v for v in one.variables if one[v].attrs.get("group") != "cost"]
                self.check(set(one.variables) == set(other.variables), f"{record}: other variables")
                variables += len(kept)
                differing += [f"{record}: {v}" for v in kept if not _same(one[v], other[v])]
        print(
            f"  {len(found)} records, {variables} variables: {len(differing)} differ from the local run"
        )
        self.check(not differing, ", ".join(differing[:5]))

    def show_begins(self, name: str) -> None:
        """The logs of runs that were begun more than once."""
        for path in sorted((self.folder / name / "runs").glob("*.log")):
            lines = path.read_text().splitlines()
            if sum(": begun" in line for line in lines) > 1:
                print(f"  {path.stem}:")
                print("".join(f"    {line[:110]}\n" for line in lines), end="")

    def steps_before(self, runs: Path) -> dict[str, int]:
        """Step of each checkpoint that there is."""
        return {path.stem: int(np.load(path)["step"]) for path in runs.glob("*.checkpoint")}


def _same(one: xr.DataArray, other: xr.DataArray) -> bool:
    a, b = one.values, other.values
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def at_work(runs: Path, host: str | None = None) -> dict:
    """A run in its middle, with a checkpoint: what its claim says, and the number of its SLURM job."""
    deadline = time.monotonic() + 600.0
    while time.monotonic() < deadline:
        for path in runs.glob("*.running.json"):
            try:
                claim = json.loads(path.read_text())
                environment = Path(f"/proc/{claim['process']}/environ").read_bytes()
                checkpoint = path.with_name(path.name.replace(".running.json", ".checkpoint"))
                saved = int(np.load(checkpoint)["step"])
            except (OSError, ValueError):
                continue
            if saved < claim["steps"] / 10 or host not in (None, claim["host"]):
                continue
            job = dict(part.split(b"=", 1) for part in environment.split(b"\0") if b"=" in part)
            claim["job"] = f"{job[b'SLURM_ARRAY_JOB_ID'].decode()}_{job[b'SLURM_ARRAY_TASK_ID'].decode()}"
            claim["run"] = path.name.split("-" + path.name.split("-")[-1])[0]
            return claim
        time.sleep(0.1)
    raise TimeoutError(f"{runs}: no run was in its middle")


def _tell(what: str, claim: dict) -> None:
    print(
        f"  -> {what}: {claim['run']}, step {claim['step']:,} of {claim['steps']:,}, "
        f"job {claim['job']}, process {claim['process']} on {claim['host']}"
    )


def kill(process, runs: Path) -> None:
    """Kills the process of a run."""
    claim = at_work(runs)
    _tell("kill -9", claim)
    os.kill(claim["process"], signal.SIGKILL)


def requeue(process, runs: Path) -> None:
    """Has SLURM take a job away and put it back into the queue, as in a preemption."""
    claim = at_work(runs)
    _tell("scontrol requeue", claim)
    subprocess.run(["scontrol", "requeue", claim["job"]], check=True)


def cancel(process, runs: Path) -> None:
    """Cancels a job."""
    claim = at_work(runs)
    _tell("scancel", claim)
    subprocess.run(["scancel", claim["job"]], check=True)


def unplug(process, runs: Path) -> None:
    """Kills all of a node at once: its daemon, the job's steps, and the run."""
    claim = at_work(runs, host="node2")
    _tell("node2 is unplugged", claim)
    namespace = os.readlink(f"/proc/{claim['process']}/ns/uts")
    for path in Path("/proc").glob("[0-9]*/ns/uts"):
        try:
            if os.readlink(path) == namespace:
                os.kill(int(path.parts[2]), signal.SIGKILL)
        except OSError:
            continue
    time.sleep(25.0)
    print(f"  25 s later: {_said('sinfo', '--noheader', '--Node', '--format=%N %T')}")
    start = f"hostname node2 && exec slurmd -N node2 -f {os.environ['SLURM_CONF']}"
    subprocess.run(["unshare", "--uts", "sh", "-c", start], check=True)
    print("  node2 is plugged in again")


def interrupt(process, runs: Path) -> None:
    """Ctrl-C in the middle."""
    claim = at_work(runs)
    _tell("Ctrl-C", claim)
    begun = time.monotonic()
    process.send_signal(signal.SIGINT)
    process.wait()
    print(f"  prompt back after {time.monotonic() - begun:.2f} s")
    while _said("squeue", "--noheader"):
        time.sleep(0.1)
    print(f"  no job left in the queue after {time.monotonic() - begun:.2f} s")


def _said(*command: str) -> str:
    return ", ".join(subprocess.run(command, capture_output=True, text=True).stdout.split("\n")).strip(
        ", "
    )


def overhead() -> None:
    """What an array of ten thousand jobs costs the program, without running it."""
    import submitit

    folder, name = Path("ten-thousand").absolute(), "sphstudy-overhead"
    executor = submitit.SlurmExecutor(folder)
    executor.update_parameters(job_name=name, time=10, mem="100M", additional_parameters={"hold": True})
    begun = time.monotonic()
    executor.map_array(str, range(10_000))
    submitted = time.monotonic()
    known = slurm.states(name)
    asked = time.monotonic()
    slurm.cancel(name)
    cancelled = time.monotonic()
    files = sum(1 for _ in folder.iterdir())
    print(
        f"  10 000 jobs in one array: submitted in {submitted - begun:.1f} s ({files} files), "
        f"{len(known or {})} states in {asked - submitted:.2f} s, cancelled in {cancelled - asked:.2f} s"
    )


def main(folder: str, grid: str) -> int:
    """Runs the trial; the exit status."""
    # Ended politely, it takes its sweep along.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    trial = Trial(Path(folder), grid)
    os.chdir(folder)
    nodes = _said("sinfo", "--noheader", "--Node", "--format=%N %c CPU %T")
    print(f"{_said('sinfo', '--version')}: {nodes}")
    early = "checkpoint=0.5"

    # Code that a process has compiled itself may round differently, in the last digit, from the same code
    # loaded from the cache; all runs that are compared load theirs.
    print("\n0. code is compiled, here and on the nodes")
    trial.sweep("compiling", grid=["n=12"])
    trial.sweep("compiling-there", CLUSTER, grid=["n=12"])
    print("\n1. on this machine")
    trial.sweep("local")
    print("\n2. the same by SLURM")
    trial.sweep("plain", CLUSTER)
    trial.compare("plain")
    print("\n3. a run is killed; it alone fails, and goes on from its checkpoint when tried again")
    trial.sweep("killed", CLUSTER, early, meanwhile=kill, expected=1)
    print(f"  checkpoints kept, with their steps: {trial.steps_before(trial.folder / 'killed' / 'runs')}")
    trial.sweep("killed", CLUSTER, early, "retry=failed")
    trial.show_begins("killed")
    trial.compare("killed")
    print("\n4. SLURM takes a job away and runs it again; the sweep needs no help")
    trial.sweep("requeued", CLUSTER, early, meanwhile=requeue)
    trial.show_begins("requeued")
    trial.compare("requeued")
    print("\n5. a job is cancelled by somebody")
    trial.sweep("cancelled", CLUSTER, early, meanwhile=cancel, expected=1)
    trial.sweep("cancelled", CLUSTER, early, "retry=failed")
    trial.show_begins("cancelled")
    trial.compare("cancelled")
    print(
        "\n6. a node fails: SLURM moves its job, the claim of the old node counts as lost after a while"
    )
    trial.sweep("unplugged", CLUSTER, early, meanwhile=unplug)
    trial.show_begins("unplugged")
    trial.compare("unplugged")
    print("\n7. Ctrl-C, several runs a job, and on with it")
    trial.sweep("interrupted", CLUSTER, early, meanwhile=interrupt, expected=130)
    trial.sweep("interrupted", CLUSTER, early, "hydra.launcher.points_per_job=3")
    trial.show_begins("interrupted")
    trial.compare("interrupted")
    print("\n8. many jobs")
    overhead()
    print(f"\n{len(trial.wrong)} of the checks failed" if trial.wrong else "\neverything held")
    return 1 if trial.wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
