"""Rules of C1, C2, D1 and D2 on made-up grids."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import change, every, grid, results

CRACK = (40, 50, 60)

I_PROPAGATION = grid(
    "mode1", CRACK, G1_error=lambda h, n: -0.19 if (h, n) == (1.5, 40) else -0.29 + 0.001 * (n - 40)
)

# Passes through zero at h̃ = 1.54.
I_PROJECTION = grid("mode1", CRACK, G2_error=lambda h, n: -0.013 * (h - 1.54))

II_PROPAGATION = grid(
    "mode2", CRACK, G1_error=lambda h, n: 0.02 if (h, n) == (1.3, 40) else -0.19 * h + 0.001 * (n - 40)
)

II_PROJECTION = grid("mode2", CRACK, G2_error=lambda h, n: 0.045 - 0.0004 * (n - 40) - 0.01 * (h - 1.3))


def alike_at_60(h, n):
    """G2's error varies by 0.6 % over h̃ at n = 40 and 50, by 0.06 % at 60."""
    return 0.031 - 0.001 * (h - 1.3) if n == 60 else 0.045 - 0.0004 * (n - 40) - 0.01 * (h - 1.3)


CASES = [
    ("C1", I_PROPAGATION, REPRODUCED),
    ("C1", change(I_PROPAGATION, 1.5, 40, G1_error=-0.3), PARTLY),
    ("C1", change(I_PROPAGATION, 1.9, 60, G1_error=-0.1), PARTLY),
    ("C1", change(I_PROPAGATION, 1.9, 50, G1_error=-0.1), NOT),
    ("C1", change(I_PROPAGATION, 1.9, 60, G1_error=0.1), NOT),
    ("C2", I_PROJECTION, REPRODUCED),
    ("C2", every(I_PROJECTION, G2_error=lambda h, n: -0.016 * (h - 1.69)), PARTLY),
    ("C2", every(I_PROJECTION, G2_error=lambda h, n: -0.004 * (h - 1.52)), PARTLY),
    ("C2", change(I_PROJECTION, 1.9, 60, G2_error=-0.0055), PARTLY),
    ("C2", change(I_PROJECTION, 1.9, 60, G2_error=-0.02), NOT),
    ("C2", every(I_PROJECTION, G2_error=lambda h, n: 0.001 + 0.01 * abs(h - 1.5)), NOT),
    ("C2", change(I_PROJECTION, 1.7, 50, G2_error=1e-5), PARTLY),
    ("C2", change(I_PROJECTION, 1.9, 50, G2_error=0.0), PARTLY),
    ("C2", change(change(I_PROJECTION, 1.9, 50, G2_error=-0.001), 1.7, 50, G2_error=-0.001), PARTLY),
    ("D1", II_PROPAGATION, REPRODUCED),
    ("D1", change(II_PROPAGATION, 1.3, 40, G1_error=-0.02), PARTLY),
    ("D1", change(II_PROPAGATION, 1.3, 40, G1_error=0.24), PARTLY),
    ("D1", change(II_PROPAGATION, 1.3, 60, G1_error=-0.1), PARTLY),
    ("D1", every(II_PROPAGATION, G1_error=lambda h, n: -0.1 * h / n), PARTLY),
    ("D1", change(II_PROPAGATION, 1.9, 60, G1_error=-0.39), NOT),
    ("D1", change(II_PROPAGATION, 1.5, 50, G1_error=-0.2), NOT),
    ("D2", II_PROJECTION, REPRODUCED),
    ("D2", change(II_PROJECTION, 1.3, 40, G2_error=0.05), PARTLY),
    ("D2", every(II_PROJECTION, G2_error=lambda h, n: 0.04 - 2e-4 * (n - 40) - 0.001 * h), PARTLY),
    ("D2", change(II_PROJECTION, 1.9, 60, G2_error=0.04), NOT),
    ("D2", change(II_PROJECTION, 1.3, 60, G2_error=-0.04), NOT),
    ("D2", change(II_PROJECTION, 1.5, 50, G2_error=0.0301), NOT),
    ("D2", change(II_PROJECTION, 1.7, 60, G2_error=0.03), NOT),
    ("D2", every(II_PROJECTION, G2_error=alike_at_60), PARTLY),
]


@pytest.mark.parametrize(("id", "rows", "verdict"), CASES)
def test_verdict(id, rows, verdict):
    finding = find(id).check(results(rows[0]["scene"], rows))
    assert finding.verdict == verdict, finding
    assert finding.numbers


@pytest.mark.parametrize(
    ("id", "rows"),
    [("C1", I_PROPAGATION), ("C2", I_PROJECTION), ("D1", II_PROPAGATION), ("D2", II_PROJECTION)],
)
def test_one_missing_cell_leaves_the_claim_open(id, rows):
    finding = find(id).check(results(rows[0]["scene"], rows[1:]))
    assert finding.verdict == UNKNOWN
    assert "(40, 1.3)" in finding.numbers


def test_frozen_visibility_is_quoted_as_a_cause():
    point = {"block": "mode1", "h": 1.5, "n": 40}
    rows = [
        point | {"varied": "", "G1_error": -0.11},
        point | {"varied": "method.retest_visibility=False", "G1_error": -0.2},
    ]
    made = results(
        "mode1",
        change(I_PROPAGATION, 1.9, 60, G1_error=0.1),
        choices=results("choices", rows),
    )
    assert "G1 is −20 % instead of −11 % at (40, 1.5)" in find("C1").check(made).cause


def test_signs_and_cells_outside_the_range_are_told():
    rows = change(I_PROJECTION, 1.5, 60, G2_error=-0.0001)
    told = find("C2").check(results("mode1", change(rows, 1.9, 60, G2_error=-0.0055))).numbers
    assert "5 of 12 positive" in told
    assert told.endswith("outside the range: (60, 1.9)")
    assert "outside" not in find("C2").check(results("mode1", I_PROJECTION)).numbers
