"""The store: one netCDF file a run, named by what determines its numbers, written atomically.

<results>/runs/<label>-<key>.nc             the record
<results>/runs/<label>-<key>.running.json   while the run is being computed: by whom, and how far it is
<results>/runs/<label>-<key>.checkpoint     where a long run goes on after an interruption
<results>/runs/<label>-<key>.log            the history of the run, try after try, with tracebacks
<results>/runs/<label>-<key>.unreadable     a damaged or foreign file of that name, set aside
<results>/sweeps/<name>.nc                  a combined dataset

Tables and `status` read the summary at the end of a record, which has a checksum of its own. All bytes
of a record are checked when a sweep decides that it need not be computed again, and when it is loaded:
for a figure, a judgement, by `measure`, from Python.
"""

import errno
import itertools
import json
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import xarray as xr

from sphstudy.configuration.run_settings import RunConfig
from sphstudy.errors import ConfigurationError
from sphstudy.store import identity
from sphstudy.store.checksum import check_seal, sealed_text
from sphstudy.store.lock import is_alive
from sphstudy.store.netcdf import UNREADABLE, load, write
from sphstudy.store.summary import Summary, of_record, of_text

_PASSING = (errno.EACCES, errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EPERM, errno.ESTALE)
"""Errors of the system that say nothing about the file."""

_NEEDED = ("title", "message", "key", "configuration", "numerics_version", "date_created")
"""Attributes without which a file is no record."""

CLAIM, CHECKPOINT = ".running.json", ".checkpoint"
"""Endings of files beside a record that stand for a run in progress, or interrupted."""

_STEM = re.compile(r"[^.].*-[0-9a-f]{16}(\.\d+)?")
"""Names of runs, <label>-<key>, set aside once more: with a number. All other files are not ours."""

REUSED = ("done", "diverged")
"""Outcomes that are results: such a point is not computed again."""


class Store:
    """The records below a folder of results.

    Parameters
    ----------
    folder : str or Path
        The folder, which need not be there.
    """

    def __init__(self, folder: str | Path):
        self.folder = Path(folder)
        self.runs = self.folder / "runs"

    def files(self, suffix: str = ".nc") -> Iterator[Path]:
        """Files of runs with this ending, by name; files of other programs in the folder are left out."""
        for path in sorted(self.runs.glob(f"*{suffix}")):
            if _STEM.fullmatch(path.name.removesuffix(suffix)):
                yield path

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
        """The history of the run, try after try."""
        return self.record_path(config).with_suffix(".log")

    def dataset_path(self, name: str) -> Path:
        """Where the combined dataset of this name lies, or would."""
        return self.folder / "sweeps" / f"{name}.nc"

    def read(self, config: RunConfig) -> xr.Dataset | None:
        """The record of a run, or None. All its bytes are checked; a damaged file is set aside."""
        return read(self.record_path(config))

    def summary(self, config: RunConfig) -> Summary | None:
        """The record's summary, or None. Its end only is read; a file that is no record is set aside."""
        return read_summary(self.record_path(config))

    def keep(self, config: RunConfig, run: xr.Dataset) -> None:
        """Writes the record of a run, sealed with its summary.

        Parameters
        ----------
        config : RunConfig
            The run.
        run : xarray.Dataset
            Its record (see record.py).

        Raises
        ------
        OSError
            If the disk does not take it.
        """
        write(run, self.record_path(config), text=of_record(run).text)

    def stamp(self, config: RunConfig) -> int:
        """When the record was written (ns), 0 if there is none: changes whenever it is written again."""
        try:
            return self.record_path(config).stat().st_mtime_ns
        except OSError:
            return 0

    def status(self, config: RunConfig) -> str:
        """Outcome of a run; without a record "running", "interrupted" or "missing"."""
        return self.checked(config)[0]

    def checked(self, config: RunConfig) -> tuple[str, Summary | None]:
        """Outcome of a run, and the summary of a record all of whose bytes were checked: a sweep takes it
        instead of computing the run.
        """
        path = self.record_path(config)
        claim = path.with_suffix(CLAIM)
        if is_alive(claim):
            return "running", None
        if (found := read_summary(path, whole=True)) is not None:
            return found.status, found
        lost = claim.exists() or path.with_suffix(CHECKPOINT).exists()
        return "interrupted" if lost else "missing", None


def record_beside(claim: Path) -> Path:
    """Where the record of a claim's run lies, or would."""
    return claim.with_name(claim.name.removesuffix(CLAIM) + ".nc")


def read_summary(path: Path, whole: bool = False) -> Summary | None:
    """The summary of a record, by its path; None if there is none or it is unreadable (then set aside).

    Parameters
    ----------
    path : Path
        The record.
    whole : bool
        Whether all bytes of the record are checked, and not the summary's alone.

    Raises
    ------
    ConfigurationError
        If the system does not let it be read now.
    """
    try:
        if whole:
            check_seal(path)
        return summarised(path)
    except UNREADABLE as error:
        _refuse(path, error)
        return None


def summarised(path: Path) -> Summary:
    """The summary of a record, by its path; raises one of UNREADABLE if it is none."""
    text = sealed_text(path)
    try:
        found = of_text(text or "")
    except ValueError:
        # Sealed by another version, or before there were seals.
        return _loaded(path)[1]
    _check(path, found)
    return found


def read(path: Path) -> xr.Dataset | None:
    """A record, loaded and closed, by its path; None if there is none, or it is damaged (then set aside).

    Raises
    ------
    ConfigurationError
        If the system does not let it be read now.
    """
    try:
        return _loaded(path)[0]
    except UNREADABLE as error:
        _refuse(path, error)
        return None


def _loaded(path: Path) -> tuple[xr.Dataset, Summary]:
    run = load(path)
    found = of_record(run)
    _check(path, found)
    if not isinstance(json.loads(found.attributes["configuration"]), dict):
        raise ValueError("without a configuration")
    return run, found


def _check(path: Path, found: Summary) -> None:
    """Raises ValueError if the summary is not that of a record of that name."""
    attributes = found.attributes
    if any(not isinstance(attributes.get(name), str) for name in _NEEDED):
        raise ValueError("not a record of this program")
    if path.name.rpartition("-")[2] != f"{attributes['key']}.nc":
        raise ValueError(f"the record of another run, {attributes['title']}-{attributes['key']}")


def _refuse(path: Path, error: Exception) -> None:
    """Sets aside a file that is no record, and says so; nothing if it is gone by now.

    Raises ConfigurationError if the system is to blame, not the file.
    """
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        return
    if isinstance(error, OSError) and error.errno in _PASSING:
        raise ConfigurationError([f"{path}: cannot be read now ({error.strerror})"]) from None
    reason = " ".join(str(error).split())
    marks = itertools.chain([""], (f".{k}" for k in itertools.count(2)))
    names = (path.with_name(f"{path.stem}{mark}.unreadable") for mark in marks)
    aside = next(name for name in names if not os.path.lexists(name))
    try:
        os.rename(path, aside)
    except FileNotFoundError:
        return
    except OSError as failure:
        print(f"{path.name}: unreadable ({reason}), left there ({failure.strerror})", file=sys.stderr)
        return
    print(f"{path.name}: unreadable ({reason}); set aside as {aside.name}", file=sys.stderr)
