"""The cheapest setting for an error, from tables made up so that the answer is known."""

import numpy as np
import pandas as pd
import pytest

from sphstudy.analysis import work_precision
from sphstudy.errors import ConfigurationError

MISSING = float("nan")
POINTS = [  # method, h, n, error, CPU seconds, status
    ("thesis", 1.5, 9, 0.08, 1.0, "done"),
    ("thesis", 1.5, 15, -0.0004, 2.0, "done"),
    ("thesis", 1.5, 21, -0.03, 4.0, "done"),
    ("tl", 1.3, 9, -0.02, 3.0, "done"),
    ("tl", 1.3, 15, -0.004, 6.0, "done"),
    ("tl", 1.3, 21, -0.0008, 12.0, "done"),
    ("tl", 1.5, 9, MISSING, 0.5, "diverged"),
    ("tl", 1.5, 15, 0.06, 9.0, "done"),
    ("tl", 1.7, 9, MISSING, MISSING, "missing"),
]


def table():
    rows = [
        {"scene": "plate", "method": m, "solve": "explicit", "solve.courant": 0.8, "h": h, "n": n,
         "record.times": [float(n)], "frequency_error_2d": error, "cpu_seconds": seconds,
         "status": status, "record": f"{m}-{h}-{n}"}
        for m, h, n, error, seconds, status in POINTS
    ]  # fmt: skip
    # The same record stands in two blocks of a study.
    return pd.DataFrame([*rows, rows[0]])


@pytest.fixture
def found():
    return work_precision.points(table(), "plate").set_index("record", drop=False)


def test_an_error_is_assured_by_all_finer_resolutions(found):
    assert len(found) == len(POINTS) - 1
    assert found["cpu_seconds"].is_monotonic_increasing
    thesis = found.loc[["thesis-1.5-9", "thesis-1.5-15", "thesis-1.5-21"]]
    assert thesis["series"].nunique() == 1
    np.testing.assert_allclose(thesis["assured"], [0.08, 0.03, 0.03])
    assert list(thesis["lucky"]) == [False, True, False]
    assert list(thesis["turns"]) == [True, False, False]
    assert list(thesis["finer"]) == [2, 1, 0]
    assert found["series"].nunique() == 3
    assert np.isnan(found.at["tl-1.5-9", "error"])
    assert not found.at["tl-1.5-9", "lucky"]


def test_only_n_and_what_is_kept_may_differ_within_a_series():
    other = table()
    other.loc[1, "solve.courant"] = 0.4
    found = work_precision.points(other, "plate").set_index("record")
    assert found.at["thesis-1.5-15", "finer"] == 0
    assert found.at["thesis-1.5-9", "finer"] == 1


def test_the_front_takes_no_luck_and_nothing_unconfirmed(found):
    assert list(work_precision.front(found)["record"]) == [
        "thesis-1.5-9",
        "thesis-1.5-15",
        "tl-1.3-9",
        "tl-1.3-15",
    ]
    assert list(work_precision.front(found)["assured"]) == [0.08, 0.03, 0.02, 0.004]


@pytest.mark.parametrize(
    ("bound", "record", "confirmed", "failed", "confirming", "luckier"),
    [
        (0.1, "thesis-1.5-15", True, None, "thesis-1.5-21", "thesis-1.5-9"),
        (0.04, "thesis-1.5-15", True, "thesis-1.5-9", "thesis-1.5-21", None),
        (0.02, "tl-1.3-9", True, "thesis-1.5-9", "tl-1.3-15", "thesis-1.5-15"),
        (0.001, "tl-1.3-21", False, "tl-1.3-15", None, "thesis-1.5-15"),
        (0.0005, "thesis-1.5-15", False, "thesis-1.5-9", "thesis-1.5-21", None),
    ],
)
def test_the_more_reliable_goes_before_the_cheaper(
    found, bound, record, confirmed, failed, confirming, luckier
):
    choice = work_precision.cheapest(found, bound)
    assert choice.row["record"] == record
    assert choice.confirmed == confirmed
    for point, expected in (
        (choice.failed, failed),
        (choice.confirming, confirming),
        (choice.luckier, luckier),
    ):
        assert (None if point is None else point["record"]) == expected


def test_an_error_that_changes_sign_is_taken_if_there_is_no_other(found):
    choice = work_precision.cheapest(found.loc[["thesis-1.5-9", "thesis-1.5-21"]], 0.1)
    assert choice.row["record"] == "thesis-1.5-9"
    assert choice.confirmed


def test_nothing_reaches_what_nothing_reaches(found):
    assert work_precision.cheapest(found, 1e-4) is None


def test_a_scene_without_an_error_of_its_own_needs_a_metric():
    changed = table().assign(scene="ring")
    with pytest.raises(ConfigurationError, match="scene=ring: add metric=NAME"):
        work_precision.points(changed, "ring")
    assert work_precision.points(changed, "ring", "frequency_error_2d")["error"].notna().sum() == 7


def test_nothing_stored_is_an_empty_table():
    empty = work_precision.points(table().drop(columns=["cpu_seconds", "frequency_error_2d"]), "plate")
    assert empty.empty
    assert work_precision.cheapest(empty, 1.0) is None
