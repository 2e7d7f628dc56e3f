"""Rules of C1 to C4 on made-up grids."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import change, grid, results

CRACK = (40, 50, 60)

PROPAGATION = grid(
    "mode1", CRACK, G1_error=lambda h, n: -0.19 if (h, n) == (1.5, 40) else -0.29 + 0.001 * (n - 40)
)

# Passes through zero at h̃ = 1.54.
PROJECTION = grid("mode1", CRACK, G2_error=lambda h, n: -0.013 * (h - 1.54))

NORMS = grid(
    "mode1",
    CRACK,
    u_x_rms=lambda h, n: 1e-5 * h * 40 / n,
    u_y_rms=lambda h, n: 2e-5 * h * 40 / n,
    stress_xx_rms=lambda h, n: 1e3 * h / n,
    stress_yy_rms=lambda h, n: 2e3 * (1 + abs(h - 1.5)) / n,
    stress_xy_rms=lambda h, n: 3e3 * (3 - h) / n,
    stress_xx_rms_inner=lambda h, n: h / n,
    stress_yy_rms_inner=lambda h, n: h / n,
)


def every(rows, **metrics):
    """The rows with these metrics replaced in all cells."""
    return [row | {name: value(row["h"], row["n"]) for name, value in metrics.items()} for row in rows]


FAVOURS_HIGH = every(NORMS, stress_yy_rms=lambda h, n: 1e3 / h / n)
SHEAR_BETTER = every(NORMS, stress_xy_rms=lambda h, n: h / n)

CASES = [
    ("C1", PROPAGATION, REPRODUCED),
    ("C1", change(PROPAGATION, 1.5, 40, G1_error=-0.3), PARTLY),
    ("C1", change(PROPAGATION, 1.9, 60, G1_error=-0.1), PARTLY),
    ("C1", change(PROPAGATION, 1.9, 50, G1_error=-0.1), NOT),
    ("C1", change(PROPAGATION, 1.9, 60, G1_error=0.1), NOT),
    ("C2", PROJECTION, REPRODUCED),
    ("C2", every(PROJECTION, G2_error=lambda h, n: -0.016 * (h - 1.69)), PARTLY),
    ("C2", every(PROJECTION, G2_error=lambda h, n: -0.004 * (h - 1.52)), PARTLY),
    ("C2", change(PROJECTION, 1.9, 60, G2_error=-0.0055), PARTLY),
    ("C2", change(PROJECTION, 1.9, 60, G2_error=-0.02), NOT),
    ("C2", every(PROJECTION, G2_error=lambda h, n: 0.001 + 0.01 * abs(h - 1.5)), NOT),
    ("C2", change(PROJECTION, 1.7, 50, G2_error=1e-5), PARTLY),
    ("C2", change(PROJECTION, 1.9, 50, G2_error=0.0), PARTLY),
    ("C2", change(change(PROJECTION, 1.9, 50, G2_error=-0.001), 1.7, 50, G2_error=-0.001), PARTLY),
    ("C3", NORMS, REPRODUCED),
    ("C3", every(NORMS, u_x_rms=lambda h, n: (1.0 + (h == 1.7)) / n), NOT),
    ("C3", change(NORMS, 1.7, 60, u_y_rms=2.6e-5), NOT),
    ("C3", change(NORMS, 1.7, 60, u_y_rms=1.7e-5), NOT),
    ("C3", every(NORMS, u_x_rms=lambda h, n: 1e-5 * (h - 0.01 * n / h**3)), PARTLY),
    ("C3", every(NORMS, u_x_rms=lambda h, n: 1e-5 / (h * n)), NOT),
    ("C3", change(NORMS, 1.7, 60, u_y_rms=4e-5), NOT),
    ("C4", NORMS, REPRODUCED),
    ("C4", FAVOURS_HIGH, PARTLY),
    ("C4", SHEAR_BETTER, PARTLY),
    ("C4", change(NORMS, 1.3, 50, stress_xy_rms=3e3 * 1.45 / 50), PARTLY),
    ("C4", change(NORMS, 1.9, 60, stress_xx_rms=1e3 * 1.2 / 60), PARTLY),
    ("C4", change(NORMS, 1.9, 50, stress_xx_rms=1e3 * 1.2 / 50), NOT),
    ("C4", every(FAVOURS_HIGH, stress_xy_rms=lambda h, n: h / n), NOT),
    ("C4", change(NORMS, 1.3, 50, stress_xx_rms=1e5), NOT),
]


@pytest.mark.parametrize(("id", "rows", "verdict"), CASES)
def test_verdict(id, rows, verdict):
    finding = find(id).check(results("mode1", rows))
    assert finding.verdict == verdict, finding
    assert finding.numbers


@pytest.mark.parametrize(
    ("id", "rows"), [("C1", PROPAGATION), ("C2", PROJECTION), ("C3", NORMS), ("C4", NORMS)]
)
def test_one_missing_cell_leaves_the_claim_open(id, rows):
    finding = find(id).check(results("mode1", rows[1:]))
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
        change(PROPAGATION, 1.9, 60, G1_error=0.1),
        choices=results("choices", rows),
    )
    assert "G1 is −20 % instead of −11 % at (40, 1.5)" in find("C1").check(made).cause


def test_signs_and_cells_outside_the_range_are_told():
    rows = change(PROJECTION, 1.5, 60, G2_error=-0.0001)
    told = find("C2").check(results("mode1", change(rows, 1.9, 60, G2_error=-0.0055))).numbers
    assert "5 of 12 positive" in told
    assert told.endswith("outside the range: (60, 1.9)")
    assert "outside" not in find("C2").check(results("mode1", PROJECTION)).numbers


def test_what_decides_the_stress_norms_is_quoted():
    cause = find("C4").check(results("mode1", FAVOURS_HIGH)).cause
    assert "stress_yy 1.3 for each n" in cause
