"""The store: atomic writes, honest reads, clear refusals."""

import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

from sphstudy.errors import ConfigurationError
from sphstudy.store import atomic
from sphstudy.store.netcdf import write
from sphstudy.store.store import Store, read


@pytest.fixture
def dataset():
    attributes = dict.fromkeys(("title", "message", "numerics_version", "date_created"), "")
    attributes |= {"configuration": "{}", "key": "a"}
    return xr.Dataset({"status": 1, "x": ("i", np.arange(5.0))}, attrs=attributes)


def test_what_is_written_is_read(tmp_path, dataset):
    write(dataset, tmp_path / "a.nc")
    xr.testing.assert_identical(read(tmp_path / "a.nc"), dataset)
    assert [p.name for p in tmp_path.iterdir()] == ["a.nc"]


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path, dataset, monkeypatch):
    write(dataset, tmp_path / "a.nc")

    def full_disk(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(atomic.os, "replace", full_disk)
    with pytest.raises(OSError, match="No space"):
        write(dataset.assign(x=("i", np.zeros(5))), tmp_path / "a.nc")
    monkeypatch.undo()
    xr.testing.assert_identical(read(tmp_path / "a.nc"), dataset)
    assert [p.name for p in tmp_path.iterdir()] == ["a.nc"]


@pytest.mark.parametrize("damage", ["truncated", "foreign", "empty", "no record"])
def test_a_damaged_record_is_set_aside_by_name_and_never_used(tmp_path, dataset, damage, capsys):
    path = tmp_path / "a.nc"
    write(dataset, path)
    if damage == "truncated":
        path.write_bytes(path.read_bytes()[:-200])
    elif damage == "foreign":
        path.write_text("not netCDF")
    elif damage == "empty":
        path.write_bytes(b"")
    else:
        write(xr.Dataset({"x": 1}), path)
    assert read(path) is None
    assert [p.name for p in tmp_path.iterdir()] == ["a.unreadable"]
    assert "a.nc: unreadable" in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_refused_by_name(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigurationError, match=r"results=.*file: cannot be written"):
        Store(tmp_path / "file").prepare()


def test_threads_do_not_disturb_each_other(tmp_path, dataset):
    """The display looks at records while the program reads and writes others: run in a process of its
    own, since the library's answer to two threads is a segmentation fault.
    """
    write(dataset.assign(y=(("j", "k"), np.ones((50, 40)))), tmp_path / "a.nc")
    script = (
        "import sys, threading; from pathlib import Path;"
        "from sphstudy.store.netcdf import write; from sphstudy.store.store import Store, read;"
        f"store, path = Store('.'), Path({str(tmp_path / 'a.nc')!r});"
        "store.record_path = lambda config: path;"
        "looks = threading.Thread(target=lambda: [store.summary(None) for _ in range(400)]);"
        "looks.start();"
        "[write(read(path), path.with_name('b.nc')) for _ in range(60)];"
        "looks.join(); assert path.exists()"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
