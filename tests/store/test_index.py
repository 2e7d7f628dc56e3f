"""The cache of summaries: for the very file only, and done without when it is no good."""

import math
import sqlite3

import numpy as np
import pytest

from sphstudy.store.index import Index
from sphstudy.store.summary import Summary, plain

ONE = Summary("done", {"message": "“m”", "list": [1, 2]}, {"error": 0.1}, {"error": {"units": "1"}})


@pytest.fixture
def path(tmp_path):
    return tmp_path / ".index.sqlite"


def kept(path, summary=ONE):
    index = Index(path)
    index.put("a.nc", (1, 2), summary)
    index.flush()
    return Index(path)


def test_what_was_put_is_got_by_another_process_too(path):
    assert kept(path).get("a.nc", (1, 2)) == ONE


@pytest.mark.parametrize("stamp", [(2, 2), (1, 3), (0, 0)])
def test_a_file_written_at_another_time_or_of_another_size_is_unknown(path, stamp):
    assert kept(path).get("a.nc", stamp) is None


def test_numbers_that_are_none_come_back_so(path):
    numbers = {"error": math.nan, "rate": math.inf}
    found = kept(path, Summary("done", {}, numbers, {name: {} for name in numbers})).get("a.nc", (1, 2))
    assert math.isnan(found.numbers["error"])
    assert found.numbers["rate"] == math.inf


def test_a_damaged_database_is_done_without_and_begun_anew(path):
    kept(path)
    path.write_bytes(b"damaged" * 1000)
    index = Index(path)
    assert index.get("a.nc", (1, 2)) is None
    index.put("a.nc", (1, 2), ONE)
    index.flush()
    assert Index(path).get("a.nc", (1, 2)) == ONE


@pytest.mark.parametrize("text", ["", "[", "[]", "{}", '["done", {}, []]', "null", '["a"]'])
def test_a_damaged_entry_is_unknown(path, text):
    kept(path)
    with sqlite3.connect(path) as file:
        file.execute("UPDATE records SET summary = ?", (text,))
    file.close()
    assert Index(path).get("a.nc", (1, 2)) is None


def test_a_folder_that_cannot_be_written_costs_the_cache_only(tmp_path):
    index = Index(tmp_path / "nowhere" / ".index.sqlite")
    index.put("a.nc", (1, 2), ONE)
    index.flush()
    assert index.get("b.nc", (1, 2)) is None


def test_a_database_that_somebody_writes_to_is_read(path):
    kept(path)
    writer = sqlite3.connect(path)
    writer.execute("BEGIN IMMEDIATE")
    assert Index(path).get("a.nc", (1, 2)) == ONE
    writer.close()


def test_attributes_are_plain():
    assert plain(np.float32(1.5)) == 1.5
    assert plain(np.arange(2)) == [0, 1]
    assert plain("text") == "text"
