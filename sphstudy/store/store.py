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

import xarray as xr

from sphstudy.configuration.run_settings import RunConfig
from sphstudy.errors import ConfigurationError
from sphstudy.store import identity
from sphstudy.store.checksum import HOW, SEALED, check_seal, seal, taken_seal
from sphstudy.store.index import Index
from sphstudy.store.lock import is_alive
from sphstudy.store.summary import Summary, of_record, of_text

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

CLAIM, CHECKPOINT = ".running.json", ".checkpoint"
"""Endings of files beside a record that stand for a run in progress, or interrupted."""

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
        return self.record_path(config).with_suffix(CLAIM)

    def checkpoint_path(self, config: RunConfig) -> Path:
        """The last checkpoint of a run that takes longer than a checkpoint's interval."""
        return self.record_path(config).with_suffix(CHECKPOINT)

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

    def keep(self, config: RunConfig, run: xr.Dataset) -> None:
        """Writes the record of a run, sealed with its summary, and adds it to the index, so that nobody
        opens it for that. Raises OSError if the disk does not take it.
        """
        path, summary = self.record_path(config), of_record(run)
        write(run, path, text=summary.text)
        with suppress(OSError):
            found = path.stat()
            self.index.put(path.name, (found.st_mtime_ns, found.st_size), summary)
            self.index.flush()

    def stamp(self, config: RunConfig) -> int:
        """When the record was written (ns), 0 if there is none: changes whenever it is written again."""
        try:
            return self.record_path(config).stat().st_mtime_ns
        except OSError:
            return 0

    def status(self, config: RunConfig) -> str:
        """Outcome of a run; without a record "running", "interrupted" or "missing"."""
        path = self.record_path(config)
        claim = path.with_suffix(CLAIM)
        if is_alive(claim):
            return "running"
        summary = self.summary_at(path)
        if summary is not None:
            return summary.status
        lost = claim.exists() or path.with_suffix(CHECKPOINT).exists()
        return "interrupted" if lost else "missing"


def summarised(path: Path) -> Summary:
    """The summary of a record file; raises one of UNREADABLE if it is none."""
    text = check_seal(path)
    try:
        summary = of_text(text or "")
    except ValueError:
        # Sealed by another version, or before there were seals.
        summary = of_record(_loaded(path))
    _check(path, summary)
    return summary


def read(path: Path) -> xr.Dataset | None:
    """A record, loaded and closed, or None if there is none or it is unreadable (then set aside)."""
    try:
        run = _loaded(path)
        _check(path, of_record(run))
        return run
    except UNREADABLE as error:
        _refuse(path, error)
        return None


def _loaded(path: Path) -> xr.Dataset:
    sealed = check_seal(path) is not None
    with FILES, xr.open_dataset(path, engine="netcdf4") as dataset:
        dataset = dataset.load()
    taken_seal(dataset.attrs, sealed)
    return dataset


def _check(path: Path, summary: Summary) -> None:
    """Raises ValueError if the summary is not that of a record of that name."""
    attributes = summary.attributes
    if any(not isinstance(attributes.get(name), str) for name in _NEEDED):
        raise ValueError("not a record of this program")
    if attributes["key"] != path.stem.rpartition("-")[2]:
        raise ValueError(f"the record of another run, {attributes['title']}-{attributes['key']}")
    if not isinstance(json.loads(attributes["configuration"]), dict):
        raise ValueError("without a configuration")


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


def write(dataset: xr.Dataset, path: Path, format: Format = "NETCDF4", text: str = "") -> None:
    """Writes a dataset so that `path` holds either the old file or the whole new one.

    format: netCDF 4, compressed and sealed with a `text`, or netCDF 3, ten times smaller where there are
    many small variables. Raises OSError if the disk does not take it.
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
            dataset = dataset.assign_attrs({SEALED: HOW})
        with FILES:
            _to_netcdf(dataset, temporary, format=format, encoding=encoding)
        if format == "NETCDF4":
            seal(Path(temporary), text)
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
