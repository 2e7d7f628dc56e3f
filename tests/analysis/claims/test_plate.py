"""Rules of V1 to V7 on made-up grids."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import change, grid, results

PLATE = (9, 15, 21)


def frequency(h, n):
    """Falls with n, grows at 1.3; at 1.5 the smallest mean."""
    if h == 1.3:
        return {9: -0.031, 15: -0.12, 21: -0.3}[n]
    return -0.03 * (21 / n) * (1.0 + 4.0 * (h - 1.5))


BASE = grid(
    "plate",
    PLATE,
    frequency_error=frequency,
    frequency_error_2d=lambda h, n: frequency(h, n) - 0.04,
    amplitude_error=lambda h, n: -frequency(h, n),
    amplitude_frequency_product=1.0,
    stress_roughness_bottom=lambda h, n: 0.3 if h == 1.3 and n > 9 else 0.01,
    stress_roughness_top=0.01,
)


def artificial(bottom, top=0.02):
    return [
        {
            "block": "artificial",
            "scene": "plate",
            "h": 1.5,
            "n": n,
            "stress_roughness_bottom": bottom[k],
            "stress_roughness_top": top,
        }
        for k, n in enumerate(PLATE)
    ]


AMPLITUDE_AT_1_9 = [row | {"amplitude_error": 2.0 - row["h"]} for row in BASE]

CASES = [
    ("V1", BASE, REPRODUCED),
    ("V1", change(BASE, 1.9, 9, frequency_error=-0.28), PARTLY),
    ("V1", change(BASE, 1.5, 21, frequency_error=-0.02), PARTLY),
    ("V1", change(BASE, 1.3, 21, frequency_error=-0.9), REPRODUCED),
    ("V1", change(BASE, 1.3, 21, frequency_error=0.01), NOT),
    ("V2", BASE, REPRODUCED),
    ("V2", change(BASE, 1.9, 9, amplitude_error=0.4), PARTLY),
    ("V2", change(BASE, 1.9, 9, amplitude_error=-0.1), NOT),
    ("V3", BASE, REPRODUCED),
    ("V3", change(BASE, 1.7, 9, amplitude_error=0.01), PARTLY),
    ("V3", change(BASE, 1.7, 9, amplitude_error=0.01, frequency_error=0.0), NOT),
    ("V4", BASE, REPRODUCED),
    ("V4", change(BASE, 1.3, 21, frequency_error=-0.1), PARTLY),
    ("V4", change(BASE, 1.9, 21, amplitude_error=0.24), NOT),
    ("V5", BASE, REPRODUCED),
    ("V5", change(BASE, 1.5, 9, frequency_error=-0.9), PARTLY),
    ("V5", change(change(BASE, 1.5, 9, frequency_error=-0.9), 1.5, 9, amplitude_error=0.9), PARTLY),
    ("V5", AMPLITUDE_AT_1_9, PARTLY),
    ("V6", BASE, REPRODUCED),
    ("V6", change(BASE, 1.3, 15, stress_roughness_bottom=0.01), PARTLY),
    ("V6", change(BASE, 1.3, 21, stress_roughness_top=0.2), PARTLY),
    ("V6", change(BASE, 1.5, 21, stress_roughness_bottom=0.2), NOT),
    ("V6", change(BASE, 1.3, 21, stress_roughness_bottom=0.01), NOT),
    ("V7", BASE + artificial((0.02, 0.02, 0.2)), REPRODUCED),
    ("V7", BASE + artificial((0.02, 0.02, 0.03)), PARTLY),
    ("V7", BASE + artificial((0.02, 0.02, 0.2), top=0.25), PARTLY),
    ("V7", BASE + artificial((0.005, 0.02, 0.03)), NOT),
]


@pytest.mark.parametrize(("id", "rows", "verdict"), CASES)
def test_verdict(id, rows, verdict):
    finding = find(id).check(results("plate", rows))
    assert finding.verdict == verdict, finding
    assert finding.numbers
    assert bool(finding.cause) == (verdict != REPRODUCED)


def test_another_best_smoothing_radius_is_told():
    rows = [row | {"frequency_error": -abs(row["h"] - 1.7) - 0.1} for row in BASE]
    rows = [row | {"amplitude_error": -row["frequency_error"]} for row in rows]
    finding = find("V5").check(results("plate", rows))
    assert finding.verdict == NOT
    assert "1.7 for each n" in finding.cause


@pytest.mark.parametrize("id", ["V1", "V2", "V3", "V4", "V5", "V6", "V7"])
def test_one_missing_cell_leaves_the_claim_open(id):
    rows = BASE + artificial((0.02, 0.02, 0.2))
    assert find(id).check(results("plate", rows)).verdict == REPRODUCED
    rows = [row for row in rows if (row["h"], row["n"]) != (1.5, 15)]
    finding = find(id).check(results("plate", rows))
    assert finding.verdict == UNKNOWN
    assert "(15, 1.5)" in finding.numbers


def test_numbers_tell_the_cells_that_decide():
    finding = find("V1").check(results("plate", change(BASE, 1.9, 9, frequency_error=-0.28)))
    assert finding.numbers.startswith("12 of 12 are negative")
    assert "without (15, 1.3), (21, 1.3), which are unstable: −28.0 % to −3 %" in finding.numbers
    assert "outside the range: (9, 1.9)" in finding.numbers
    assert "2-D elasticity of the same plate the errors are −34 % to −7" in finding.cause
    finding = find("V3").check(results("plate", change(BASE, 1.7, 9, amplitude_error=0.01)))
    assert "amplitude 1 % at (9, 1.7)" in finding.numbers
