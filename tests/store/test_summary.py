"""A record ends with its summary, sealed together with all else."""

import math

import pytest
import xarray as xr

from sphstudy.store.checksum import HOW, SEALED, check_seal, seal
from sphstudy.store.store import summarised, write
from sphstudy.store.summary import Summary, of_record, of_text


@pytest.fixture
def run():
    attributes = dict.fromkeys(("title", "message", "numerics_version", "date_created"), "“a”\n")
    attributes |= {"configuration": "{}", "key": "a"}
    metric = {"units": "1", "long_name": "an error", "group": "metric"}
    return xr.Dataset(
        {"status": 1, "error": ((), 0.25, metric), "none": ((), math.inf, metric), "x": ("i", [1.0])},
        attrs=attributes,
    )


def test_a_summary_is_its_text(run):
    summary = of_record(run)
    assert summary.status == "done"
    assert set(summary.numbers) == {"error", "none"}
    assert of_text(summary.text) == summary


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{}",
        '["done", {}]',
        '["done", {}, {"a": 1}]\n{}',
        '["done", {}, {}]\n{"a": {}}',
        '["done", {}, []]\n{}',
        '["done", {}, {}]\n[]',
        "null\n1",
    ],
)
def test_what_is_no_summary_is_refused(text):
    with pytest.raises(ValueError, match=r"."):
        of_text(text)


def test_the_end_of_a_record_says_what_the_record_says(run, tmp_path):
    path = tmp_path / "x-a.nc"
    write(run, path, text=of_record(run).text)
    told = summarised(path)
    write(run, path)
    assert summarised(path) == told == of_record(run)


def test_the_summary_is_what_is_looked_at(run, tmp_path):
    """Not the netCDF file before it, which takes a hundred times longer to open."""
    path = tmp_path / "x-a.nc"
    other = Summary("failed", {**run.attrs}, {}, {})
    write(run, path, text=other.text)
    assert summarised(path) == other


@pytest.mark.parametrize("place", [0, 700, -1, -30, -50, -58, -70])
def test_a_changed_byte_anywhere_is_noticed(run, tmp_path, place):
    path = tmp_path / "x-a.nc"
    write(run, path, text=of_record(run).text)
    data = bytearray(path.read_bytes())
    data[place] ^= 1
    path.write_bytes(data)
    with pytest.raises((ValueError, OSError)):
        summarised(path)


def test_a_text_comes_back_from_behind_any_file(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"what it holds")
    assert check_seal(path) is None
    seal(path, "“in short”")
    assert check_seal(path) == "“in short”"


def test_a_seal_of_another_version_is_passed(run, tmp_path):
    path = tmp_path / "x-a.nc"
    write(run.assign_attrs({SEALED: "in another way"}), path, "NETCDF3_64BIT")
    assert SEALED not in summarised(path).attributes
    write(run.assign_attrs({SEALED: HOW}), path, "NETCDF3_64BIT")
    with pytest.raises(ValueError, match="cut off"):
        summarised(path)
