"""Datasets in netCDF files: written whole or not at all, sealed, loaded after their seal is checked."""

import errno
import os
import threading
from pathlib import Path
from typing import Any, Literal

import xarray as xr

from sphstudy.errors import ConfigurationError
from sphstudy.store.atomic import replacing
from sphstudy.store.checksum import HOW, SEALED, check_seal, remove_marker, seal

Format = Literal["NETCDF4", "NETCDF3_64BIT"]

FILES = threading.RLock()
"""Held while a netCDF file is open: the library is not made for threads, and the display is one."""

UNREADABLE = (OSError, LookupError, RuntimeError, ValueError, AttributeError, TypeError)
"""Exceptions of reading a file that is damaged, or no netCDF file of this program."""

_HEAD = 1_000_000
"""Bytes that a file may take beside its numbers."""


def load(path: Path) -> xr.Dataset:
    """A dataset, loaded and closed. All bytes of a sealed file are checked.

    Raises
    ------
    OSError, LookupError, RuntimeError, ValueError, AttributeError, TypeError
        If the file is not there, damaged, or no netCDF file.
    """
    sealed = check_seal(path)
    with FILES, xr.open_dataset(path, engine="netcdf4") as dataset:
        dataset = dataset.load()
    remove_marker(dataset.attrs, sealed)
    return dataset


def write(dataset: xr.Dataset, path: Path, format: Format = "NETCDF4", text: str = "") -> None:
    """Writes a dataset so that `path` holds either the old file or the whole new one.

    Parameters
    ----------
    dataset : xarray.Dataset
        What is written.
    path : Path
        The file; its folder is made if need be.
    format : {"NETCDF4", "NETCDF3_64BIT"}
        netCDF 4, compressed and sealed; or netCDF 3, ten times smaller for many small variables.
    text : str
        Summary that stands in the seal.

    Raises
    ------
    OSError
        If the disk does not take it.
    """
    sealed = format == "NETCDF4"
    packed = {"zlib": True, "complevel": 2, "shuffle": True}
    encoding = {
        name: packed
        for name, variable in dataset.variables.items()
        if sealed and variable.ndim > 0 and variable.dtype.kind in "fi"
    }
    if sealed:
        dataset = dataset.assign_attrs({SEALED: HOW})
    with replacing(path) as temporary:
        with FILES:
            _to_netcdf(dataset, str(temporary), format=format, encoding=encoding)
        if sealed:
            seal(temporary, text)


def _to_netcdf(dataset: xr.Dataset, path: str, **how: Any) -> None:
    """Raises OSError where HDF5 only says that it could not write, in several ways if a disk is full."""
    try:
        dataset.to_netcdf(path, engine="netcdf4", **how)
    except (RuntimeError, OSError) as error:
        room = os.statvfs(Path(path).parent)
        free = room.f_bavail * room.f_frsize
        if free < dataset.nbytes + _HEAD:
            text = f"{os.strerror(errno.ENOSPC)} ({free / 1e6:.1f} MB are free)"
            raise OSError(errno.ENOSPC, text, path) from None
        raise OSError(errno.EIO, str(error), path) from None


def read_dataset(name: str, results: str | Path) -> xr.Dataset:
    """A combined dataset.

    Parameters
    ----------
    name : str
        Its file, or its name among the sweeps of a folder of results.
    results : str or Path
        That folder.

    Raises
    ------
    ConfigurationError
        If there is none, or it cannot be read.
    """
    candidates = [Path(name), Path(results) / "sweeps" / f"{name}.nc"]
    for path in candidates:
        if path.is_file():
            try:
                return load(path)
            except (OSError, ValueError, RuntimeError) as error:
                raise ConfigurationError([f"{path}: cannot be read ({error})"]) from None
    raise ConfigurationError([f"{name}: there is neither {' nor '.join(map(str, candidates))}"])
