"""Settings of hydra/launcher=slurm, and what submits jobs by them."""

import math
import shutil
from pathlib import Path
from typing import Annotated, Any

from pydantic import StringConstraints

from sphstudy.configuration.execution import GRACE, thread_settings
from sphstudy.errors import ConfigurationError
from sphstudy.parameters import checked, count, described, number, parameters

OneLine = Annotated[str, StringConstraints(min_length=1, pattern=r"^[^\x00-\x1f\x7f]+$")]
Option = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z-]*(=[^\x00-\x1f\x7f]+)?$")]

NODE_CACHE = (
    'cache="${SLURM_TMPDIR:-${TMPDIR:-/tmp}}/sphstudy-$(id -u)"',
    'mkdir -p -m 700 "$cache"',
    # Code is loaded from there: a folder that somebody else has laid out in /tmp will not do.
    '[ -O "$cache" ] || cache=$(mktemp -d)',
    'export XDG_CACHE_HOME="$cache"',
)
"""Shell lines that make compiled code be kept on the node (see compilation.py)."""

_OWN = {"array", "chdir", "error", "job-name", "output", "signal", "test-only", "time", "wait"}


@parameters
class Parameters:
    """Settings of hydra/launcher=slurm."""

    partition: OneLine | None = described("partition; null: the cluster's default")
    timeout_min: int = count("time of a job, in minutes", ge=1)
    mem_gb: float = number("memory of a job", "GiB", gt=0)
    cpus_per_task: int = count("cores of a job", ge=1)
    points_per_job: int = count("runs of a job, one after the other", ge=1)
    jobs_per_array: int = count("jobs of an array at most", ge=1)
    array_parallelism: int = count("jobs of an array at work at once", ge=1)
    resubmissions: int = count("how often a job that was interrupted is submitted again", ge=0)
    node_cache: bool = described("whether compiled code is kept on the node")
    setup: tuple[OneLine, ...] = described("shell lines before a job's runs")
    additional: tuple[Option, ...] = described("further options of sbatch, without their hyphens")


def settings_of(values: dict[str, Any]) -> Parameters:
    """The launcher's settings, if jobs can be submitted from here.

    Raises ConfigurationError with every complaint.
    """
    complaints: list[str] = []
    found = checked(Parameters, values, "hydra.launcher.", complaints)
    if found is not None:
        own = sorted(_OWN & set(_options(found)))
        complaints += [f"hydra.launcher.additional={name}: is set by the program itself" for name in own]
    try:
        import submitit  # noqa: F401
    except ImportError:
        complaints.append("hydra/launcher=slurm: needs submitit: pip install 'sphstudy[cluster]'")
    missing = [name for name in ("sbatch", "srun", "squeue", "scancel") if not shutil.which(name)]
    if missing:
        complaints.append(f"hydra/launcher=slurm: there is no {', '.join(missing)} on this machine")
    if complaints:
        raise ConfigurationError(complaints)
    return found


def minutes(settings: Parameters, time_limit: float | None) -> int:
    """Time of a job whose runs may take so long each (s), with some grace."""
    if time_limit is None:
        return settings.timeout_min
    needed = settings.points_per_job * (time_limit + GRACE)
    return min(settings.timeout_min, math.ceil(needed / 60.0))


def executor(settings: Parameters, folder: Path, name: str, time_limit: float | None) -> Any:
    """submitit's executor, which keeps its files in `folder`, for jobs called `name`."""
    import submitit

    threads = [f"export {k}={v}" for k, v in thread_settings(settings.cpus_per_task).items()]
    options = _options(settings)
    if "no-requeue" not in options:
        options["requeue"] = True
    # submitit asks for a SIGUSR2 before the end of time, which would end a short job that it meets while
    # Python starts. None is wanted, since there are checkpoints: SIGURG is one that nobody minds.
    options["signal"] = "URG@1"
    found = submitit.SlurmExecutor(folder)
    found.update_parameters(
        job_name=name,
        partition=settings.partition,
        time=minutes(settings, time_limit),
        mem=f"{math.ceil(settings.mem_gb * 1024)}M",
        cpus_per_task=settings.cpus_per_task,
        array_parallelism=settings.array_parallelism,
        stderr_to_stdout=True,
        setup=[*threads, *(NODE_CACHE if settings.node_cache else ()), *settings.setup],
        additional_parameters=options,
    )
    return found


def _options(settings: Parameters) -> dict[str, Any]:
    parts = [option.partition("=") for option in settings.additional]
    return {name: value if given else True for name, given, value in parts}
