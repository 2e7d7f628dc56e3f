"""Command line: separates sub-commands and flags from overrides, and says how it ended."""

import contextlib
import errno
import importlib
import os
import sys
from collections.abc import Callable, Iterator
from functools import partial

from sphstudy.running.interrupt import interruptible, on_interrupt

USAGE = """\
sphstudy - batch studies with smoothed particle hydrodynamics of elastic solids and fracture

  sphstudy h=1.5 n=40                              one run (scene=mode1 method=thesis by default)
  sphstudy -m h=1.3,1.5,1.7,1.9 n=40,50,60         a sweep: every combination, in parallel
  sphstudy -m scene=plate h=1.5,1.7 n=9,15,21      the same in another scene
  sphstudy study mode1                             a named study: run what is missing, compare, report
  sphstudy study thesis --dry-run                  what would run, why, and what it would cost
  sphstudy study speed                             what pairs, terms, a start and a second core cost here
  sphstudy report mode1                            its figures and page again, from stored data
  sphstudy compare mode1                           against the stored reference; exit status 1 outside
  sphstudy compare mode1 printed                   against the values that the thesis prints
  sphstudy compare before.nc after.nc tolerance=1e-6    two datasets, cell by cell
  sphstudy judge stability                         which stored runs are sound, and when others went bad
  sphstudy measure mode1                           metrics again from stored fields
  sphstudy reference mode1                         stored results become the stored reference
  sphstudy extrapolate mode1 G2_error --order 1    to zero particle spacing, with uncertainty
  sphstudy advise scene=plate error=0.1%           the cheapest setting for an error, from stored points
  sphstudy peers                                   other codes on the plate, set up and run side by side
  sphstudy status                                  what the results folder holds, run by run
  sphstudy status mode1                            how far a study is, how fast, and what is left
  sphstudy prune                                   stale records and their space; --yes removes them
  sphstudy adopt                                   stored runs of an earlier version serve again
  sphstudy list                                    scenes, methods, solvers, metrics, studies
  sphstudy describe scene plate                    every setting of one of them: value, unit, meaning

settings (key=value, before or after -m; several values with commas make a sweep)
  scene=NAME method=NAME solve=NAME                what, how discretised, how solved
  h=1.5 n=40                                       relative smoothing radius; resolution
  scene.E=2e6  solve.courant=0.4  record.times=[1.5]   anything that `describe` shows
  results=FOLDER                                   where records go (default: results)
  checkpoint=60                                    seconds between two checkpoints of a long run
  threads=2                                        of one long run by steps: the same bits, sooner
  hydra.launcher.n_jobs=4                          how many runs at once (default: one per core)
  hydra/launcher=slurm                             runs as jobs of a cluster (basic: one after the other)
  time_limit=600 memory_limit=2                    of one run (s, GiB): it ends as timeout, as failed
  retry=failed                                     runs that failed (timeout, all) are tried again

flags
  -m, --multirun   run every combination of the values given
  -f, --force      run again what is already there
  --dry-run        with `study` or `peers`: run nothing
  --order P        with `extrapolate`: the order of convergence, observed if it is not given
  --output FILE    with `extrapolate`: a netCDF file that keeps the result
  -h, --help       this text            --version   the version

A run that is already in the results folder is not run again. Each run leaves one netCDF file in
results/runs, a sweep one labelled dataset in results/sweeps, a study a page in results/reports.
Exit status: 0 all points done (a diverged point is a result), 1 a point failed or has no record, the disk
takes no more, or a metric lies outside its accepted interval, 2 wrong input, 130 interrupted, 141 nobody
reads the output any more (`| head`; runs that are finished are kept).
"""

_FLAGS = {
    "-m": "sweep",
    "--multirun": "sweep",
    "-f": "force",
    "--force": "force",
    "--dry-run": "dry run",
}
_COMMANDS = {
    "list": "describe",
    "describe": "describe",
    "report": "review",
    "compare": "review",
    "measure": "review",
    "reference": "review",
    "status": "status",
    "prune": "prune",
    "judge": "judge",
    "extrapolate": "extrapolate",
    "advise": "advise",
    "adopt": "adopt",
    "peers": "peers",
}
"""Where `<command>_command` of each is, imported when it is asked for."""

_INTERRUPTED = "sphstudy: interrupted; finished runs are kept"
_DISK = (errno.EACCES, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.ENOSPC, errno.EROFS, errno.ESTALE)
"""What a disk may answer to whoever writes to it."""


def main(arguments: list[str] | None = None) -> int:
    """Runs the program; returns its exit status."""
    try:
        status = _answered(list(sys.argv[1:] if arguments is None else arguments))
        # Now, or an error would show only when the interpreter ends.
        print(end="", flush=True)
        return status
    except KeyboardInterrupt:
        _complain(_INTERRUPTED)
        return 130
    except BrokenPipeError:
        return 141
    except SystemExit as error:
        # What rich makes of a BrokenPipeError.
        if not isinstance(error.__context__, BrokenPipeError):
            raise
        return 141
    except OSError as error:
        if error.errno not in _DISK:
            raise
        _complain(f"sphstudy: {error}; finished runs are kept")
        return 1
    finally:
        _drop_what_nobody_takes()


def _answered(arguments: list[str]) -> int:
    if {"-h", "--help"} & set(arguments):
        print(USAGE, end="")
        return 0
    if "--version" in arguments:
        from sphstudy import __version__

        print(__version__)
        return 0
    with on_interrupt(_leave_at_once):
        from sphstudy.errors import ConfigurationError
    try:
        with on_interrupt(_leave_at_once):
            work = _work(arguments)
        with on_interrupt(_leave_if_compiling), interruptible(), _collecting_rarely():
            return work()
    except ConfigurationError as error:
        for complaint in error.complaints:
            print(f"sphstudy: {complaint}", file=sys.stderr)
        return 2


def _complain(line: str) -> None:
    with contextlib.suppress(OSError):
        print(line, file=sys.stderr)


def _leave_at_once() -> None:
    """While modules are imported, or functions compiled: libraries make other errors of a
    KeyboardInterrupt, or tell of it themselves.
    """
    # Not by way of sys.stderr, which the process may be writing to. A display may have hidden the cursor.
    shown = "\n\x1b[?25h" if os.isatty(2) and os.environ.get("TERM", "dumb") != "dumb" else ""
    with contextlib.suppress(OSError):
        os.write(2, f"{shown}{_INTERRUPTED}\n".encode())
    os._exit(130)


def _leave_if_compiling() -> None:
    """LLVM, interrupted, may drop the KeyboardInterrupt and say so, or leave behind what crashes as it is
    tidied up.
    """
    lock = sys.modules.get("numba.core.compiler_lock")
    if lock is not None and lock.global_compiler_lock.is_locked():
        _leave_at_once()


@contextlib.contextmanager
def _collecting_rarely() -> Iterator[None]:
    """Points, records and what is told of them are many and stay: looking for garbage among them time and
    again takes as long as making them. At the end of the process it is not looked for at all.
    """
    import atexit
    import gc

    atexit.unregister(gc.freeze)
    atexit.register(gc.freeze)
    before = gc.get_threshold()
    gc.set_threshold(500_000, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _drop_what_nobody_takes() -> None:
    """Output that its reader or its disk refused: Python would try again at its end, and complain."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _work(arguments: list[str]) -> Callable[[], int]:
    """What is to be done, imported. Raises ConfigurationError if the arguments are wrong."""
    name = arguments[0] if arguments else ""
    if name not in _COMMANDS:
        return _runs(arguments)
    module = importlib.import_module(f"sphstudy.commands.{_COMMANDS[name]}")
    return partial(getattr(module, f"{name}_command"), arguments[1:])


def _runs(arguments: list[str]) -> Callable[[], int]:
    from sphstudy.errors import ConfigurationError

    named = arguments[:1] == ["study"]
    arguments = arguments[named:]
    flags = {_FLAGS[a] for a in arguments if a in _FLAGS}
    overrides = [a for a in arguments if a not in _FLAGS]
    unknown = [a for a in overrides[named:] if a.startswith("-") or "=" not in a]
    if unknown:
        raise ConfigurationError(
            [f"{a}: neither a command, a flag nor key=value (see sphstudy --help)" for a in unknown]
        )
    if "dry run" in flags and not named:
        raise ConfigurationError(["--dry-run: goes with study"])
    if named and overrides[:1] == ["speed"]:
        from sphstudy.commands.speed import speed_command

        return partial(speed_command, overrides[1:], "dry run" in flags)
    from sphstudy.running import sweep

    force = "force" in flags
    if named:
        return partial(sweep.study_command, overrides, force, "dry run" in flags)
    return partial(sweep.run_command, overrides, many="sweep" in flags, force=force)


if __name__ == "__main__":
    sys.exit(main())
