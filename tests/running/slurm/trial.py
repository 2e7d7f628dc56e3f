"""The mode I grid through a real SLURM, with kills, compared bit for bit with a local run."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr

from sphstudy.running.slurm import queries
from sphstudy.running.slurm.node import read_note
from sphstudy.store.record import STATUS

GRIDS = {
    "small": ["h=1.3,1.5,1.7,1.9", "n=20,24"],
    "thesis": ["h=1.3,1.5,1.7,1.9", "n=40,50,60"],
}
CLUSTER = "hydra/launcher=slurm"
EARLY = "checkpoint=0.5"
PROGRESS = re.compile(r"\d+ of \d+ runs done|^\[\d+/\d+\]|^ |^dataset|^$")


class Trial:
    """One grid, one folder for each way of running it."""

    def __init__(self, folder: Path, grid: str):
        self.folder, self.grid = folder, GRIDS[grid]
        self.wrong: list[str] = []
        # SLURM writes there how each job has ended, those that it then requeues included.
        self._ended = Path(os.environ["SLURM_CONF"]).with_name("ended")

    def sweep(
        self, name: str, *more: str, meanwhile=None, expected: int = 0, grid=None, meets: str = ""
    ) -> None:
        """Runs a sweep to its end, records in `name`, and `meanwhile(process, runs)` beside it.

        `expected`: its exit status; `meets`: a state in which SLURM has to say that a job has ended.
        """
        before = len(self._states())
        given = ["-m", *(grid or self.grid), f"results={self.folder / name}", *more]
        print(f"$ sphstudy {' '.join(given)}")
        begun = time.monotonic()
        with open(self.folder / "said", "w+") as said:
            command = [sys.executable, "-m", "sphstudy", *given]
            process = subprocess.Popen(
                command,
                cwd=self.folder,
                # Whatever runs this in the background may have told its children to ignore Ctrl-C.
                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
                stdout=said,
                stderr=said,
                text=True,
            )
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
        states = Counter(self._states()[before:])
        if states:
            print(f"  SLURM: {', '.join(f'{count} {state}' for state, count in states.items())}")
        self.check(not meets or meets in states, f"{name}: no job was {meets}")

    def _states(self) -> list[str]:
        """States in which jobs of sweeps have ended, in the order of their ends."""
        if not self._ended.exists():
            return []
        return re.findall(r" Name=sphstudy-\w+ JobState=(\w+)", self._ended.read_text())

    def records(self, name: str) -> dict[str, Path]:
        """The records of a folder, by file name."""
        return {path.name: path for path in sorted((self.folder / name / "runs").glob("*.nc"))}

    def outcomes(self, name: str, **expected: int) -> None:
        """How many runs failed or timed out, what their records say, and where they would go on."""
        found: Counter[str] = Counter()
        for file, path in self.records(name).items():
            with xr.open_dataset(path) as run:
                outcome, message = STATUS[int(run["status"])], run.attrs["message"]
            if outcome != "done":
                found[outcome] += 1
                checkpoint = path.with_suffix(".checkpoint")
                step = f"step {np.load(checkpoint)['step']:,}" if checkpoint.exists() else "no step"
                print(f"  {file}: {outcome}, checkpoint of {step}: {message}")
        self.check(found == expected, f"{name}: {dict(found)}, not {expected}")

    def check(self, holds: bool, complaint: str) -> None:
        """Notes what does not hold."""
        if not holds:
            self.wrong.append(complaint)
            print(f"  WRONG: {complaint}")

    def compare(self, name: str, part: int | None = None) -> None:
        """Every record against that of the local run: all variables but costs, bit for bit.

        `part`: so many records of the local run have to be there, if not all and no others.
        """
        self.show_begins(name)
        local, found = self.records("local"), self.records(name)
        shared = local.keys() & found.keys()
        complete = local.keys() == found.keys() if part is None else len(shared) == part
        self.check(complete, f"{name}: not the same records")
        variables, differing = 0, []
        for record in sorted(shared):
            with xr.open_dataset(local[record]) as one, xr.open_dataset(found[record]) as other:
                kept = [v for v in one.variables if one[v].attrs.get("group") != "cost"]
                self.check(set(one.variables) == set(other.variables), f"{record}: other variables")
                variables += len(kept)
                differing += [f"{record}: {v}" for v in kept if not _same(one[v], other[v])]
        print(
            f"  {len(shared)} records, {variables} variables: {len(differing)} differ from the local run"
        )
        self.check(not differing, ", ".join(differing[:5]))

    def show_begins(self, name: str) -> None:
        """The logs of runs that were begun more than once."""
        for path in sorted((self.folder / name / "runs").glob("*.log")):
            lines = path.read_text().splitlines()
            if sum(": begun" in line for line in lines) > 1:
                print(f"  {path.stem}:")
                print("".join(f"    {line[:110]}\n" for line in lines), end="")


def _same(one: xr.DataArray, other: xr.DataArray) -> bool:
    a, b = one.values, other.values
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def at_work(runs: Path, host: str | None = None, first: bool | None = None) -> dict:
    """A run in its middle, with a checkpoint: what its claim says, and the number of its SLURM job.

    `host`: on that node; `first`: whether it is the first run of its job.
    """
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
            if saved <= claim["steps"] / 10 or host not in (None, claim["host"]):
                continue
            job = dict(part.split(b"=", 1) for part in environment.split(b"\0") if b"=" in part)
            task = job[b"SLURM_ARRAY_TASK_ID"].decode()
            claim["job"] = f"{job[b'SLURM_ARRAY_JOB_ID'].decode()}_{task}"
            [note] = runs.parent.glob(f"slurm/*/{task}.json")
            if first is not None and first != (read_note(note).at == 0):
                continue
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


def preempt(process, runs: Path) -> None:
    """Has a job that goes first ask for the node of a run."""
    claim = at_work(runs)
    _tell("another job goes first", claim)
    command = ["sbatch", "--partition=urgent", f"--nodelist={claim['host']}", "--output=/dev/null"]
    subprocess.run([*command, "--wrap=sleep 5"], check=True, stdout=subprocess.DEVNULL)


def stall(process, runs: Path) -> None:
    """Stops the first run of one job, and a later one of the other, until SLURM ends them."""
    claims = []
    for first in (True, False):
        claims.append(at_work(runs, first=first))
        _tell("stops" if first else "stops, not the first of its job", claims[-1])
        os.kill(claims[-1]["process"], signal.SIGSTOP)
    # SLURM's warning of the end of time sets them going again.
    while time.time() < claims[0]["started"] + 57.0:
        for claim in claims:
            os.kill(claim["process"], signal.SIGSTOP)
        time.sleep(0.2)


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
    known = queries.states(name)
    asked = time.monotonic()
    queries.cancel(name)
    cancelled = time.monotonic()
    files = sum(1 for _ in folder.iterdir())
    print(
        f"  10 000 jobs in one array: submitted in {submitted - begun:.1f} s ({files} files), "
        f"{len(known or {})} states in {asked - submitted:.2f} s, cancelled in {cancelled - asked:.2f} s"
    )


def plain(trial: Trial) -> None:
    """Nothing happens."""
    trial.sweep("plain", CLUSTER, meets="COMPLETED")
    trial.compare("plain")


def killed(trial: Trial) -> None:
    """A run is killed; it alone fails, and goes on from its checkpoint when tried again."""
    trial.sweep("killed", CLUSTER, EARLY, meanwhile=kill, expected=1)
    trial.outcomes("killed", failed=1)
    trial.sweep("killed", CLUSTER, EARLY, "retry=failed")
    trial.compare("killed")


def requeued(trial: Trial) -> None:
    """SLURM takes a job away and runs it again; the sweep needs no help."""
    trial.sweep("requeued", CLUSTER, EARLY, meanwhile=requeue)
    trial.compare("requeued")


def preempted(trial: Trial) -> None:
    """A job of a partition that goes first takes the node; SLURM runs the job again when that is over."""
    trial.sweep("preempted", CLUSTER, EARLY, meanwhile=preempt, meets="PREEMPTED")
    trial.compare("preempted")


def ousted(trial: Trial) -> None:
    """The same where SLURM cancels the job; the program submits it again."""
    given = [CLUSTER, EARLY, "hydra.launcher.partition=frail"]
    trial.sweep("ousted", *given, meanwhile=preempt, meets="PREEMPTED")
    trial.compare("ousted")


def cancelled(trial: Trial) -> None:
    """A job is cancelled by somebody."""
    trial.sweep("cancelled", CLUSTER, EARLY, meanwhile=cancel, expected=1)
    trial.outcomes("cancelled", failed=1)
    trial.sweep("cancelled", CLUSTER, EARLY, "retry=failed")
    trial.compare("cancelled")


def timeout(trial: Trial) -> None:
    """The time of a job is over in its first run, which times out, and of another in a later run, which
    gets another job; the first goes on from its checkpoint when tried again.
    """
    given = [CLUSTER, EARLY, "hydra.launcher.timeout_min=1", "hydra.launcher.points_per_job=4"]
    trial.sweep("timeout", *given, meanwhile=stall, expected=1, meets="TIMEOUT")
    trial.outcomes("timeout", timeout=1)
    trial.sweep("timeout", *given, "retry=timeout")
    trial.compare("timeout")


def memory(trial: Trial) -> None:
    """A run takes more memory than its job has; it alone fails, and the others of the job are done."""
    peaks = [float(xr.load_dataset(path)["peak_memory"]) for path in trial.records("local").values()]
    # The run with so many particles takes half a GiB more than the small ones.
    sizes = f"{trial.grid[1]},600"
    given = [CLUSTER, f"hydra.launcher.mem_gb={max(peaks) / 2**30 + 0.1:.2f}"]
    many = len(sizes.split(","))
    given += [f"hydra.launcher.points_per_job={many}"]
    trial.sweep("memory", *given, grid=["h=1.9", sizes], expected=1, meets="FAILED")
    trial.outcomes("memory", failed=1)
    trial.compare("memory", part=many - 1)


def unplugged(trial: Trial) -> None:
    """A node fails: SLURM moves its job, the claim of the old node counts as lost after a while."""
    trial.sweep("unplugged", CLUSTER, EARLY, meanwhile=unplug)
    trial.compare("unplugged")


def interrupted(trial: Trial) -> None:
    """Ctrl-C, several runs a job, and on with it."""
    trial.sweep("interrupted", CLUSTER, EARLY, meanwhile=interrupt, expected=130)
    trial.sweep("interrupted", CLUSTER, EARLY, "hydra.launcher.points_per_job=3")
    trial.compare("interrupted")


def many(trial: Trial) -> None:
    """Ten thousand jobs in one array."""
    overhead()


CASES = (
    plain,
    killed,
    requeued,
    preempted,
    ousted,
    cancelled,
    timeout,
    memory,
    unplugged,
    interrupted,
    many,
)


def main(folder: str, grid: str, *chosen: str) -> int:
    """Runs the trial, or the cases that are chosen by name; the exit status."""
    # Ended politely, it takes its sweep along.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    names = [case.__name__ for case in CASES]
    if grid not in GRIDS or not set(chosen) <= set(names):
        print(f"trial.py: takes {' or '.join(GRIDS)}, and any of {', '.join(names)}", file=sys.stderr)
        return 2
    trial = Trial(Path(folder), grid)
    os.chdir(folder)
    nodes = _said("sinfo", "--noheader", "--Node", "--partition=all", "--format=%N %c CPU %T")
    print(f"{_said('sinfo', '--version')}: {nodes}, memory by {os.environ['MEMORY']}", flush=True)
    print("\nlocal: on this machine", flush=True)
    trial.sweep("local")
    for case in CASES:
        # Without `plain`, nodes would still have to compile, which takes a job of one minute too long.
        if not chosen or case is plain or case.__name__ in chosen:
            print(f"\n{case.__name__}: {' '.join((case.__doc__ or '').split())}", flush=True)
            case(trial)
    print(f"\n{len(trial.wrong)} of the checks failed" if trial.wrong else "\neverything held")
    return 1 if trial.wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
