"""A record ends with its summary, sealed together with all else."""

import hashlib
import math

import pytest
import xarray as xr

from sphstudy.store.checksum import HOW, SEALED, check_seal, seal, sealed_text
from sphstudy.store.netcdf import load, write
from sphstudy.store.store import summarised
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


FOOT = 64
"""Bytes behind the text: its own digest, its length, the mark, the digest of the file."""


@pytest.mark.parametrize("place", [0, 700, -1, -30, -40, -50, -60, -70])
def test_a_changed_byte_anywhere_is_noticed_when_the_record_is_loaded(run, tmp_path, place):
    path = tmp_path / "x-a.nc"
    write(run, path, text=of_record(run).text)
    data = bytearray(path.read_bytes())
    data[place] ^= 1
    path.write_bytes(data)
    with pytest.raises((ValueError, OSError)):
        load(path)


def test_a_changed_byte_of_the_summary_is_noticed_when_it_is_looked_at(run, tmp_path):
    path, text = tmp_path / "x-a.nc", of_record(run).text
    write(run, path, text=text)
    whole = path.read_bytes()
    for place in range(-FOOT - len(text.encode()), -32):
        data = bytearray(whole)
        data[place] ^= 1
        path.write_bytes(data)
        with pytest.raises((ValueError, OSError)):
            summarised(path)


def test_bytes_that_are_lost_or_added_before_the_summary_are_noticed(run, tmp_path):
    path = tmp_path / "x-a.nc"
    write(run, path, text=of_record(run).text)
    whole = path.read_bytes()
    for changed in (whole[100:], b"x" + whole, whole[:-1]):
        path.write_bytes(changed)
        with pytest.raises((ValueError, OSError)):
            summarised(path)


@pytest.mark.parametrize("text", ["“in short”", "", "long " * 10_000])
def test_a_text_comes_back_from_behind_any_file(tmp_path, text):
    path = tmp_path / "a"
    path.write_bytes(b"what it holds")
    assert not check_seal(path)
    assert sealed_text(path) is None
    seal(path, text)
    assert check_seal(path)
    assert sealed_text(path) == text


def test_a_record_that_an_earlier_version_sealed_is_read_and_checked_whole(run, tmp_path):
    path = tmp_path / "x-a.nc"
    text = of_record(run).text.encode()
    write(run.assign_attrs({SEALED: HOW}), path, "NETCDF3_64BIT")
    body = path.read_bytes() + text + len(text).to_bytes(8, "little") + b"sphstudy, digest"
    path.write_bytes(body + hashlib.sha256(body).digest())
    assert summarised(path) == of_record(run)
    xr.testing.assert_identical(load(path), run)
    path.write_bytes(b"x" + body[1:] + hashlib.sha256(body).digest())
    with pytest.raises(ValueError, match="not those that were written"):
        summarised(path)


def test_a_seal_of_another_version_is_passed(run, tmp_path):
    path = tmp_path / "x-a.nc"
    write(run.assign_attrs({SEALED: "in another way"}), path, "NETCDF3_64BIT")
    assert SEALED not in summarised(path).attributes
    write(run.assign_attrs({SEALED: HOW}), path, "NETCDF3_64BIT")
    with pytest.raises(ValueError, match="cut off"):
        summarised(path)
