"""Rules of B1 to B3 on made-up points."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import results

POINT = {
    "scene": "bending",
    "h": 1.7,
    "n": 21,
    "centreline_error_max": 2e-4,
    "end_angle_error": -0.05,
    "end_angle_error_2d": 0.02,
    "centreline_roughness_wall": 3e-5,
    "centreline_roughness_middle": 1e-7,
    "centreline_roughness_end": 2e-4,
}

LONG = {"scene": "bending", "h": 1.7, "n": 9, "spacing_smallest_bottom": 0.8}
LONG |= {f"spacing_spread_{part}_11s": 0.005 for part in ("bottom", "top", "rest")}
LONG |= {"spacing_spread_bottom": 0.1, "spacing_spread_top": 0.02, "spacing_spread_rest": 0.01}

SCENE = {"deflection": -0.04, "L": 1.0, "end_time": 160.0}


@pytest.mark.parametrize(
    ("id", "changed", "verdict"),
    [
        ("B1", {}, REPRODUCED),
        ("B1", {"end_angle_error": 0.3}, REPRODUCED),
        ("B1", {"end_angle_error": 0.01}, PARTLY),
        ("B1", {"end_angle_error": 1.0}, PARTLY),
        ("B1", {"centreline_error_max": 5e-4}, PARTLY),
        ("B1", {"centreline_error_max": 5e-4, "end_angle_error": 1.0}, NOT),
        ("B2", {}, REPRODUCED),
        ("B2", {"centreline_roughness_wall": 1e-5}, PARTLY),
        ("B2", {"centreline_roughness_end": 5e-5}, PARTLY),
        ("B2", {"centreline_roughness_middle": 4e-6}, PARTLY),
        ("B2", {"centreline_roughness_middle": 1e-3}, NOT),
    ],
)
def test_verdict(id, changed, verdict):
    finding = find(id).check(results("bending", [POINT | changed], SCENE))
    assert finding.verdict == verdict, finding
    assert finding.numbers


@pytest.mark.parametrize(
    ("changed", "verdict"),
    [
        ({}, REPRODUCED),
        ({"spacing_spread_bottom": 0.03}, PARTLY),
        ({"spacing_spread_bottom": 0.008, "spacing_spread_top": 0.001, "spacing_spread_rest": 0.0}, NOT),
        ({"spacing_spread_top": 0.2}, NOT),
        ({"spacing_spread_rest": 0.2}, NOT),
        ({"spacing_spread_rest_11s": 0.04}, NOT),
    ],
)
def test_clumping(changed, verdict):
    finding = find("B3").check(results("bending_long", [LONG | changed], SCENE))
    assert finding.verdict == verdict, finding
    assert bool(finding.cause) == (verdict != REPRODUCED)


def test_without_the_early_state_the_claim_is_open():
    late = {name: value for name, value in LONG.items() if not name.endswith("_11s")}
    assert find("B3").check(results("bending_long", [late], SCENE)).verdict == UNKNOWN


def test_only_the_thesis_s_case_counts():
    assert find("B1").check(results("bending", [POINT | {"n": 9}], SCENE)).verdict == UNKNOWN


def test_the_error_is_told_in_terms_of_the_deflection():
    finding = find("B1").check(results("bending", [POINT], SCENE | {"deflection": -0.02}))
    assert "centreline within 1 % of the deflection" in finding.numbers
