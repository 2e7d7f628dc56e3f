"""One point: solve it, measure it, store it. Whatever happens becomes a record, except Ctrl-C."""

import resource
import sys
import time

import xarray as xr

from sphstudy.catalogue import method_module, scene_module, solver_module
from sphstudy.configuration.execution import Execution
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.metrics.metric import Metric
from sphstudy.numerics.compile_timer import CompileTimer
from sphstudy.running.interrupt import interruptible
from sphstudy.running.limits import memory_limited
from sphstudy.store import identity, record
from sphstudy.store.checkpoint_file import CheckpointFile
from sphstudy.store.job import Job
from sphstudy.store.lock import ELSEWHERE, Claim
from sphstudy.store.log import run_log
from sphstudy.store.measured import measured
from sphstudy.store.provenance import provenance
from sphstudy.store.store import Store


class TimedOut(Exception):
    """A run has taken longer than it was given."""


def compute(config: RunConfig, store: Store, execution: Execution, known: int = 0) -> str:
    """Computes a point and writes its record, going on from its last checkpoint if there is one.

    Parameters
    ----------
    config : RunConfig
        The point.
    store : Store
        Where its record goes.
    execution : Execution
        How it is carried out.
    known : int
        Stamp of the record that is to be replaced, 0 if there is none (see Store.stamp).

    Returns
    -------
    str
        The outcome. Of a record with another stamp, which somebody else has written meanwhile, its
        status; ELSEWHERE if another process is computing the run.

    Raises
    ------
    OSError
        If the disk takes no claim or no record: the run can be done again from its last checkpoint.
        Whatever else goes wrong becomes a record; only Ctrl-C passes through.
    """
    claim = Claim(store.claim_path(config))
    if not claim.take():
        return ELSEWHERE
    with claim, run_log(store.log_path(config)) as log:
        if store.stamp(config) != known and (there := store.summary(config)):
            return there.status
        keeper = CheckpointFile(store.checkpoint_path(config), execution.checkpoint)
        started = _now()
        log.info(f"begun, numerics {identity.numerics_version(config)}, results {store.folder}")
        try:
            with memory_limited(execution.memory_limit), interruptible(insisting=True):
                run = _solved(config, claim, keeper, execution)
        except TimedOut as error:
            run = record.without_result("timeout", str(error), _attributes(config))
        except Exception as error:
            message = f"{type(error).__name__}: {error}".splitlines()[0]
            log.exception(message)
            run = record.without_result("failed", message, _attributes(config))
        run.attrs["date_created"], run.attrs["threads"] = started, str(execution.threads)
        store.keep(config, run)
        outcome = record.STATUS[int(run["status"])]
        log.info(f"{outcome} {run.attrs['message']}".rstrip())
    # Tried again, such a run goes on from where it had come.
    if outcome not in ("failed", "timeout"):
        keeper.remove()
    return outcome


def computed(config: RunConfig, store: Store, execution: Execution) -> xr.Dataset:
    """The record of a run that is computed here and now, whatever is stored (see `compute`).

    Raises RuntimeError if another process is computing it.
    """
    if compute(config, store, execution, store.stamp(config)) == ELSEWHERE:
        raise RuntimeError(f"{config.label} is being computed by another process")
    run = store.read(config)
    assert run is not None, "written just now"
    return run


def run_job(job: Job) -> str:
    """`compute` for a worker."""
    return compute(job.config, job.store, job.execution, job.known)


def give_up(config: RunConfig, store: Store, outcome: str, why: str) -> None:
    """Writes the record of a run whose process is gone, and takes its claim away.

    Parameters
    ----------
    config, store : RunConfig, Store
        The point, and where its record goes.
    outcome, why : str
        Status of the record ("failed" or "timeout") and its message.
    """
    run = record.without_result(outcome, why, _attributes(config))
    run.attrs["date_created"], run.attrs["threads"] = _now(), ""
    store.keep(config, run)
    with run_log(store.log_path(config)) as log:
        log.info(f"{outcome} {why}")
    store.claim_path(config).unlink(missing_ok=True)


def _solved(config: RunConfig, claim: Claim, keeper: CheckpointFile, execution: Execution) -> xr.Dataset:
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    solver = solver_module(config.solve.name)
    wall, cpu = time.perf_counter(), time.process_time()
    with CompileTimer() as compiling:

        def progress(step: int, steps: int) -> None:
            claim.update(step, steps)
            spent = time.perf_counter() - wall - compiling.so_far
            if execution.time_limit is not None and spent > execution.time_limit:
                raise TimedOut(
                    f"{spent:.0f} s, step {step} of {steps} (limit {execution.time_limit:g} s)"
                )

        problem = scene.build(config)
        solution = solver.run(problem, config, method, progress, keeper, execution.threads)
    cost = {
        "cpu_seconds": Metric(
            keeper.cpu_seconds + time.process_time() - cpu - compiling.cpu,
            "s",
            "CPU time without compilation",
        ),
        "wall_seconds": Metric(
            keeper.wall_seconds + time.perf_counter() - wall - compiling.wall,
            "s",
            "wall time without compilation",
        ),
        "compile_seconds": Metric(compiling.wall, "s", "wall time spent compiling"),
        "steps": Metric(solution.steps, "1", "time steps, or linear systems solved"),
        "spacing": Metric(problem.body.mean_spacing, "m", "particle spacing Δ"),
        "particles": Metric(problem.body.x.size, "1", "particles"),
        "pairs": Metric(solution.pairs, "1", "unordered pairs of neighbours, at most"),
        "peak_memory": Metric(_peak_memory(), "byte", "peak memory of the process"),
    }
    run = record.fields(problem, solution)
    run = record.with_outcome(run, solution.outcome, solution.message, cost, _attributes(config))
    return measured(run, config)


def _attributes(config: RunConfig) -> dict[str, str]:
    return {
        "title": config.label,
        "configuration": config.text,
        "key": identity.key(config),
        "numerics_version": identity.numerics_version(config),
        **provenance(),
    }


def _peak_memory() -> float:
    # Linux counts in KiB, macOS in bytes.
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def _now() -> str:
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
