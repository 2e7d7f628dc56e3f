"""One point: solve it, measure it, store it. Whatever happens becomes a record, except Ctrl-C."""

import json
import resource
import sys
import time
import traceback
from typing import Any

import xarray as xr
from omegaconf import DictConfig, OmegaConf

from sphstudy import identity, record
from sphstudy.checkpoint_file import CheckpointFile
from sphstudy.compile_timer import CompileTimer
from sphstudy.config import RunConfig, method_module, scene_module, solver_module, validate
from sphstudy.metrics.metric import Metric, measure
from sphstudy.progress import Marker
from sphstudy.provenance import provenance
from sphstudy.store import Store, write


def run_point(config: RunConfig, store: Store, checkpoint: float, threads: int = 1) -> xr.Dataset:
    """Computes a point, from its last checkpoint if there is one, writes its record and returns it.

    `checkpoint`: wall time between two checkpoints (s); `threads`: as many as the solver may take.
    """
    keeper = CheckpointFile(store.checkpoint_path(config), checkpoint)
    with Marker(store.marker_path(config)) as marker:
        started = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
        try:
            run = _solved(config, marker, keeper, threads)
        except Exception as error:
            store.log_path(config).write_text(traceback.format_exc())
            message = f"{type(error).__name__}: {error}".splitlines()[0]
            run = record.with_outcome(xr.Dataset(), "failed", message, {}, _attributes(config))
        run.attrs["date_created"], run.attrs["threads"] = started, str(threads)
        write(run, store.record_path(config))
    # A failed run is run again: what it had computed until its last checkpoint is not lost.
    if record.STATUS[int(run["status"])] != "failed":
        keeper.remove()
    return run


def _solved(config: RunConfig, marker: Marker, keeper: CheckpointFile, threads: int) -> xr.Dataset:
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    solver = solver_module(config.solve.name)
    wall, cpu = time.perf_counter(), time.process_time()
    with CompileTimer() as compiling:
        problem = scene.build(config)
        solution = solver.run(problem, config, method, marker.update, keeper, threads)
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


def measured(run: xr.Dataset, config: RunConfig) -> xr.Dataset:
    """The record with its metrics, measured from its fields; none if the run is not done, or if its
    solver leaves numbers of its own (`HEADLINE`) and no motion.

    What metrics remark is the message of a run that is done.
    """
    metrics = {}
    own = hasattr(solver_module(config.solve.name), "HEADLINE")
    if record.STATUS[int(run["status"])] == "done" and not own:
        metrics = measure(run, config, scene_module(config.scene.kind).METRICS)
        remarks = [metric.remark for metric in metrics.values() if metric.remark]
        run.attrs["message"] = "; ".join(dict.fromkeys(remarks))
    return record.with_metrics(run, metrics, identity.metrics_version(config))


def _attributes(config: RunConfig) -> dict[str, str]:
    return {
        "title": config.label,
        "configuration": json.dumps(config.as_dict(), sort_keys=True),
        "key": identity.key(config),
        "numerics_version": identity.numerics_version(config),
        **provenance(),
    }


def _peak_memory() -> float:
    # Linux counts in KiB, macOS in bytes.
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def task(composed: DictConfig) -> str:
    """Hydra's task: one point of a sweep, in whichever process the launcher chose."""
    values: Any = OmegaConf.to_container(composed, resolve=True)
    store, checkpoint = Store(values.pop("results")), float(values.pop("checkpoint"))
    threads = values.pop("threads")
    run = run_point(validate(values), store, checkpoint, threads)
    return record.STATUS[int(run["status"])]
