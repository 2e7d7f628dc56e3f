"""The store: one netCDF file a run, named by what determines its numbers, written atomically.

<results>/runs/<label>-<key>.nc             the record
<results>/runs/<label>-<key>.running.json   while it is being computed: who does, and how far it is
<results>/runs/<label>-<key>.checkpoint     where a long run goes on after an interruption
<results>/runs/<label>-<key>.log            what became of it, try after try, with tracebacks and warnings
<results>/runs/<label>-<key>.unreadable     a file of that name that was no record, set aside
<results>/runs/.index.sqlite                summaries of records, kept so that 20 000 need not be opened
"""

import errno
import itertools
import json
import os
import sys
import tempfile
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal

import netCDF4
import xarray as xr

from sphstudy import identity
from sphstudy.claim import is_alive
from sphstudy.config import ConfigurationError, RunConfig
from sphstudy.index import Index, Summary, plain
from sphstudy.record import STATUS
from sphstudy.seal import SEALED, check_seal, seal, taken_seal

Format = Literal["NETCDF4", "NETCDF3_64BIT"]


FILES = threading.RLock()
"""Held while a netCDF file is open: the library is not made for threads, and the display is one."""

UNREADABLE = (OSError, LookupError, RuntimeError, ValueError, AttributeError, TypeError)
"""What reading a file that is no record, or a damaged one, may raise."""

_PASSING = (errno.EACCES, errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EPERM, errno.ESTALE)
"""Errors of the system that say nothing about the file."""

_NEEDED = ("title", "message", "key", "configuration", "numerics_version", "date_created")
"""Attributes without which a file is no record."""

_HEAD = 1_000_000
"""Bytes that a file may take beside its numbers."""

REUSED = ("done", "diverged")
"""Outcomes that are results: such a point is not computed again."""


class Store:
    """The records below a folder of results."""

    def __init__(self, folder: str | Path):
        self.folder = Path(folder)
        self.runs = self.folder / "runs"
        self.index = Index(self.runs / ".index.sqlite")

    def prepare(self) -> None:
        """Makes the folders. Raises ConfigurationError if they cannot be written."""
        try:
            self.runs.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=self.runs):
                pass
        except OSError as error:
            raise ConfigurationError(
                [f"results={self.folder}: cannot be written ({error.strerror or error})"]
            ) from None

    def record_path(self, config: RunConfig) -> Path:
        """Where the record of this run lies, or would."""
        return self.runs / f"{config.label}-{identity.key(config)}.nc"

    def claim_path(self, config: RunConfig) -> Path:
        """The file that exists while the run is being computed."""
        return self.record_path(config).with_suffix(".running.json")

    def checkpoint_path(self, config: RunConfig) -> Path:
        """The last checkpoint of a run that takes longer than a checkpoint's interval."""
        return self.record_path(config).with_suffix(".checkpoint")

    def log_path(self, config: RunConfig) -> Path:
        """What became of the run, try after try."""
        return self.record_path(config).with_suffix(".log")

    def read(self, config: RunConfig) -> xr.Dataset | None:
        """The record of a run, or None. A file that cannot be read is set aside, with its name kept."""
        return read(self.record_path(config))

    def summary(self, config: RunConfig) -> Summary | None:
        """The record's summary, or None; a file that cannot be read is set aside."""
        return self.summary_at(self.record_path(config))

    def summary_at(self, path: Path) -> Summary | None:
        """The same of a record by its path. From the index, if the file is the one that was seen then."""
        try:
            found = path.stat()
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            _refuse(path, error)
            return None
        stamp = (found.st_mtime_ns, found.st_size)
        if (known := self.index.get(path.name, stamp)) is not None:
            return known
        try:
            summary = summarised(path)
        except UNREADABLE as error:
            _refuse(path, error)
            return None
        self.index.put(path.name, stamp, summary)
        return summary

    def index_record(self, config: RunConfig) -> None:
        """Adds the record just written to the index, so that nobody has to open it for that."""
        path = self.record_path(config)
        with suppress(*UNREADABLE):
            found = path.stat()
            self.index.put(path.name, (found.st_mtime_ns, found.st_size), summarised(path))
            self.index.flush()

    def stamp(self, config: RunConfig) -> int:
        """When the record was written (ns), 0 if there is none: changes whenever it is written again."""
        try:
            return self.record_path(config).stat().st_mtime_ns
        except OSError:
            return 0

    def status(self, config: RunConfig) -> str:
        """Outcome of a run; without a record "running", "interrupted" or "missing"."""
        claim = self.claim_path(config)
        if is_alive(claim):
            return "running"
        summary = self.summary(config)
        if summary is not None:
            return summary.status
        lost = claim.exists() or self.checkpoint_path(config).exists()
        return "interrupted" if lost else "missing"


def summarised(path: Path) -> Summary:
    """The summary of a record file; raises one of UNREADABLE if it is none."""
    sealed = check_seal(path)
    # Twenty times faster than through xarray, which matters for a report on a hundred runs.
    with FILES, netCDF4.Dataset(path) as run:
        # Nothing here is masked, NaN says what is missing: looking for masks takes most of the time.
        run.set_auto_maskandscale(False)
        attributes = {name: run.getncattr(name) for name in run.ncattrs()}
        taken_seal(attributes, sealed)
        status = _status(path, run, attributes)
        own = {
            name: {key: plain(text) for key, text in v.__dict__.items() if not key.startswith("_")}
            for name, v in run.variables.items()
            if v.ndim == 0
        }
        numbers = {
            name: (float(run[name][...]), described)
            for name, described in own.items()
            if described.get("group") in ("metric", "cost")
        }
    return Summary(status, {name: plain(value) for name, value in attributes.items()}, numbers)


def read(path: Path) -> xr.Dataset | None:
    """A record, loaded and closed, or None if there is none or it is unreadable (then set aside)."""
    try:
        run = _loaded(path)
        _status(path, run, run.attrs)
        return run
    except UNREADABLE as error:
        _refuse(path, error)
        return None


def _loaded(path: Path) -> xr.Dataset:
    sealed = check_seal(path)
    with FILES, xr.open_dataset(path, engine="netcdf4") as dataset:
        dataset = dataset.load()
    taken_seal(dataset.attrs, sealed)
    return dataset


def _status(path: Path, run: Any, attributes: dict[str, Any]) -> str:
    """The outcome that a file says. Raises ValueError or LookupError if it is no record of that name."""
    if any(not isinstance(attributes.get(name), str) for name in _NEEDED):
        raise ValueError("not a record of this program")
    if attributes["key"] != path.stem.rpartition("-")[2]:
        raise ValueError(f"the record of another run, {attributes['title']}-{attributes['key']}")
    if not isinstance(json.loads(attributes["configuration"]), dict):
        raise ValueError("without a configuration")
    code = int(run["status"][...])
    if not 0 < code < len(STATUS):
        raise ValueError(f"outcome {code}")
    return STATUS[code]


def _refuse(path: Path, error: Exception) -> None:
    """Sets aside what cannot be read, by name; nothing if it is gone by now.

    Raises ConfigurationError if the system is to blame, not the file.
    """
    if isinstance(error, FileNotFoundError):
        return
    if isinstance(error, OSError) and error.errno in _PASSING:
        raise ConfigurationError([f"{path}: cannot be read now ({error.strerror})"]) from None
    told = " ".join(str(error).split())
    marks = itertools.chain([""], (f".{k}" for k in itertools.count(2)))
    names = (path.with_name(f"{path.stem}{mark}.unreadable") for mark in marks)
    aside = next(name for name in names if not os.path.lexists(name))
    try:
        os.rename(path, aside)
    except FileNotFoundError:
        return
    except OSError as failure:
        print(f"{path.name}: unreadable ({told}), left there ({failure.strerror})", file=sys.stderr)
        return
    print(f"{path.name}: unreadable ({told}); set aside as {aside.name}", file=sys.stderr)


def read_dataset(name: str, results: str | Path) -> xr.Dataset:
    """A combined dataset, by file or by the name it has in a folder of results.

    Raises ConfigurationError if there is none.
    """
    candidates = [Path(name), Path(results) / "sweeps" / f"{name}.nc"]
    for path in candidates:
        if path.is_file():
            try:
                return _loaded(path)
            except (OSError, ValueError, RuntimeError) as error:
                raise ConfigurationError([f"{path}: cannot be read ({error})"]) from None
    raise ConfigurationError([f"{name}: there is neither {' nor '.join(map(str, candidates))}"])


def write(dataset: xr.Dataset, path: Path, format: Format = "NETCDF4") -> None:
    """Writes a dataset so that `path` holds either the old file or the whole new one.

    format: netCDF 4, compressed and sealed, or netCDF 3, ten times smaller where there are many small
    variables. Raises OSError if the disk does not take it.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    packed = {"zlib": True, "complevel": 2, "shuffle": True}
    encoding = {
        name: packed
        for name, variable in dataset.variables.items()
        if format == "NETCDF4" and variable.ndim > 0 and variable.dtype.kind in "fi"
    }
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=".writing-", suffix=".nc")
    os.close(handle)
    try:
        if format == "NETCDF4":
            dataset = dataset.assign_attrs({SEALED: "a digest follows the file's end"})
        with FILES:
            _to_netcdf(dataset, temporary, format=format, encoding=encoding)
        if format == "NETCDF4":
            seal(Path(temporary))
        else:
            with open(temporary, "rb") as file:
                os.fsync(file.fileno())
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _to_netcdf(dataset: xr.Dataset, path: str, **how: Any) -> None:
    """Raises OSError where HDF5 only says that it could not write, in several ways if a disk is full."""
    try:
        dataset.to_netcdf(path, engine="netcdf4", **how)
    except (RuntimeError, OSError) as error:
        room = os.statvfs(Path(path).parent)
        free = room.f_bavail * room.f_frsize
        if free < dataset.nbytes + _HEAD:
            told = f"{os.strerror(errno.ENOSPC)} ({free / 1e6:.1f} MB are free)"
            raise OSError(errno.ENOSPC, told, path) from None
        raise OSError(errno.EIO, str(error), path) from None
