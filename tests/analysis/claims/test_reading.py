"""Reading of grids, and that the studies' claims are the thesis's."""

import numpy as np
import pandas as pd
import pytest

from sphstudy.analysis.claims import reading, tensile_instability
from sphstudy.analysis.claims.claim import UNKNOWN, every_claim, find
from sphstudy.analysis.effects import CONTROL
from sphstudy.analysis.results import Missing
from sphstudy.configuration import study_file
from tests.support.results import change, grid, results

IDS = [
    *(f"V{k}" for k in range(1, 8)), "B1", "B2", "B3", *(f"C{k}" for k in range(1, 5)),
    *(f"D{k}" for k in range(1, 5)), "S1", "S2",
]  # fmt: skip


def test_every_claim_stands_in_one_study_and_those_of_the_thesis_are_all_there():
    listed = [id for name in study_file.names() for id in study_file.load(name).claims]
    assert sorted(listed) == sorted(every_claim())
    assert set(IDS) <= set(listed)
    for claim in every_claim().values():
        assert claim.text
        assert claim.source
        assert all(claim.meaning.values())


@pytest.mark.parametrize("name", study_file.names())
def test_without_points_there_is_no_verdict(name):
    empty = results(name, [])
    for id in study_file.load(name).claims:
        finding = find(id).check(empty)
        assert finding.verdict == UNKNOWN, id
        assert finding.numbers, id


def test_a_grid_is_whole_or_missing_and_the_cells_are_named():
    rows = grid("plate", reading.PLATE, size=lambda h, n: h * n)
    found = reading.whole_grid(results("plate", rows), "size", reading.PLATE)
    assert found.at[1.7, 15] == 1.7 * 15
    with pytest.raises(Missing, match=r"size at \(n, h̃\) = \(15, 1.7\)"):
        reading.whole_grid(results("plate", change(rows, 1.7, 15, size=np.nan)), "size", reading.PLATE)
    with pytest.raises(Missing, match=r"\(21, 1.9\)"):
        reading.whole_grid(results("plate", rows[:-1]), "size", reading.PLATE)


def test_cells_beyond_the_thesis_s_grid_do_not_count():
    rows = [*grid("plate", (5, *reading.PLATE), size=1.0), {"scene": "plate", "h": 1.4, "n": 9}]
    found = reading.whole_grid(results("plate", rows), "size", reading.PLATE)
    assert found.shape == (4, 3)


def test_unstable_cells_are_those_of_the_study():
    made = results("plate", grid("plate", reading.PLATE, size=1.0))
    mask = reading.unstable(made, made.grid("size"))
    assert reading.cells(mask) == "(15, 1.3), (21, 1.3)"


def test_trends_are_of_sizes():
    errors = pd.DataFrame([[-3.0, -2.0, 1.0], [1.0, 2.0, -2.5]], index=[1.3, 1.5], columns=[9, 15, 21])
    assert reading.falls(errors).to_numpy().tolist() == [[True, True], [False, False]]
    assert reading.best_smoothing(errors).tolist() == [1.5, 1.3, 1.3]


def test_words():
    assert reading.interval((-0.275, -0.025)) == "−0.275 to −0.025"
    assert reading.interval((-0.005, 0.009), 100.0) == "−0.5 to +0.9"
    assert reading.interval((4, 8)) == "4 to 8"
    assert reading.choices(pd.Series({9: 1.5, 15: 1.5})) == "1.5 for each n"
    assert reading.choices(pd.Series({9: 1.5, 15: 1.3})) == "1.5 (n = 9), 1.3 (n = 15)"


@pytest.mark.parametrize(("h", "side"), [(1.3, "tension"), (1.7, "compression"), (1.5, "inflection")])
def test_the_neighbour_decides_which_side_is_unstable(h, side):
    assert side in tensile_instability.unstable_side(h)


def test_kernels_are_compared_as_far_as_they_are_stored():
    point = {"block": "plate", "h": 1.3, "n": 15, "scene.H0": 0.02, "method.artificial_stress": 0.0}
    rows = [
        point | {"method.kernel": "quintic", "frequency_error": -0.05, "stress_roughness_bottom": 0.01}
    ]
    told = tensile_instability.kernel_test(
        results("plate", [], conjectures=results("conjectures", rows)), 1.3
    )
    assert told == (
        "ω error and roughness below the axis at (15, 1.3): quintic kernel (h⁴ W'' = +0.0093) −5 %, 1 %"
    )
    assert tensile_instability.kernel_test(results("plate", []), 1.3) == ""


def test_open_choices_are_quoted_with_their_extremes_once_all_are_stored():
    point = {"block": "mode1", "h": 1.5, "n": 40}
    made = {"": 0.0, "a=1": -0.02, "b=2": 0.03, "c=3": 0.01}
    rows = [point | {"varied": varied, "G1_error": error} for varied, error in made.items()]
    # The control is no choice; what diverged has no error.
    rows.append(point | {"varied": f"{CONTROL}=1", "G1_error": -0.5})
    rows.append(point | {"varied": "e=5", "G1_error": float("nan"), "status": "diverged"})
    asked = results("mode1", [], choices=results("choices", rows))
    part = [*rows, point | {"varied": "f=6", "G1_error": float("nan"), "status": "missing"}]
    incomplete = results("mode1", [], choices=results("choices", part))
    assert reading.options(incomplete, "mode1", "G1_error") == ""
    told = reading.options(asked, "mode1", "G1_error")
    assert "give −2 % (a=1) to +3 % (b=2) at (40, 1.5)" in told
    point = lambda varied: reading.elsewhere(asked, "choices", "mode1", {"varied": varied}, "G1_error")  # noqa: E731
    assert point("c=3") == 0.01
    assert point("d=4") is None
    assert reading.options(results("mode1", []), "mode1", "G1_error") == ""
