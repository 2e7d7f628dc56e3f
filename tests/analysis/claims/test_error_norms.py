"""Rules of C3, C4, D3 and D4 on made-up grids."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import change, every, grid, results

CRACK = (40, 50, 60)
FIELDS = ("u_x", "u_y", "stress_xx", "stress_yy", "stress_xy")

I_NORMS = grid(
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

II_NORMS = grid("mode2", CRACK, **{f"{field}_rms": lambda h, n: h / n for field in FIELDS})

PARITY = grid(
    "mode2", CRACK, stress_xx_parity_defect_ahead=0.2, stress_yy_parity_defect_ahead=lambda h, n: h
)


def at_1_5(h, n):
    """Smallest at h̃ = 1.5."""
    return (1.0 + abs(h - 1.5)) / n


FAVOURS_HIGH = every(I_NORMS, stress_yy_rms=lambda h, n: 1e3 / h / n)
SHEAR_BETTER = every(I_NORMS, stress_xy_rms=lambda h, n: h / n)
SYMMETRIC = grid("mode2", CRACK, stress_xx_parity_defect_ahead=0.01, stress_yy_parity_defect_ahead=0.01)

CASES = [
    ("C3", I_NORMS, REPRODUCED),
    ("C3", every(I_NORMS, u_x_rms=lambda h, n: (1.0 + (h == 1.7)) / n), NOT),
    ("C3", change(I_NORMS, 1.7, 60, u_y_rms=2.6e-5), NOT),
    ("C3", change(I_NORMS, 1.7, 60, u_y_rms=1.7e-5), NOT),
    ("C3", every(I_NORMS, u_x_rms=lambda h, n: 1e-5 * (h - 0.01 * n / h**3)), PARTLY),
    ("C3", every(I_NORMS, u_x_rms=lambda h, n: 1e-5 / (h * n)), NOT),
    ("C3", change(I_NORMS, 1.7, 60, u_y_rms=4e-5), NOT),
    ("C4", I_NORMS, REPRODUCED),
    ("C4", FAVOURS_HIGH, PARTLY),
    ("C4", SHEAR_BETTER, PARTLY),
    ("C4", change(I_NORMS, 1.3, 50, stress_xy_rms=3e3 * 1.45 / 50), PARTLY),
    ("C4", change(I_NORMS, 1.9, 60, stress_xx_rms=1e3 * 1.2 / 60), PARTLY),
    ("C4", change(I_NORMS, 1.9, 50, stress_xx_rms=1e3 * 1.2 / 50), NOT),
    ("C4", every(FAVOURS_HIGH, stress_xy_rms=lambda h, n: h / n), NOT),
    ("C4", change(I_NORMS, 1.3, 50, stress_xx_rms=1e5), NOT),
    ("D3", II_NORMS, REPRODUCED),
    ("D3", every(II_NORMS, u_x_rms=at_1_5, u_y_rms=at_1_5), PARTLY),
    ("D3", every(II_NORMS, u_x_rms=at_1_5, u_y_rms=at_1_5, stress_xx_rms=at_1_5), NOT),
    ("D3", change(II_NORMS, 1.7, 60, stress_xy_rms=1.0), NOT),
    ("D4", PARITY, REPRODUCED),
    ("D4", change(PARITY, 1.7, 60, stress_xx_parity_defect_ahead=0.09), PARTLY),
    ("D4", change(PARITY, 1.7, 60, stress_yy_parity_defect_ahead=0.01), PARTLY),
    ("D4", SYMMETRIC, NOT),
]


@pytest.mark.parametrize(("id", "rows", "verdict"), CASES)
def test_verdict(id, rows, verdict):
    finding = find(id).check(results(rows[0]["scene"], rows))
    assert finding.verdict == verdict, finding
    assert finding.numbers


@pytest.mark.parametrize(
    ("id", "rows"), [("C3", I_NORMS), ("C4", I_NORMS), ("D3", II_NORMS), ("D4", PARITY)]
)
def test_one_missing_cell_leaves_the_claim_open(id, rows):
    finding = find(id).check(results(rows[0]["scene"], rows[1:]))
    assert finding.verdict == UNKNOWN
    assert "(40, 1.3)" in finding.numbers


def test_what_decides_the_stress_norms_is_quoted():
    cause = find("C4").check(results("mode1", FAVOURS_HIGH)).cause
    assert "stress_yy 1.3 for each n" in cause


def test_what_load_and_artificial_stress_do_to_the_antisymmetry_is_told():
    point = {"block": "mode2", "h": 1.7, "n": 40, "scene.K": 35.8, "method.artificial_stress": 0.0}
    rows = [point | {f"stress_{c}_parity_defect_ahead": 0.01 for c in ("xx", "yy")}]
    made = results("mode2", PARITY, conjectures=results("conjectures", rows))
    told = find("D4").check(made).numbers
    assert told.endswith(
        "σxx and σyy at (40, 1.7): a thousandth of the load, without artificial stress 1 % and 1 %"
    )


def test_norms_that_are_lower_elsewhere_are_told():
    cause = find("D3").check(results("mode2", every(II_NORMS, u_x_rms=at_1_5, u_y_rms=at_1_5))).cause
    assert "u_y at n = 60: h̃ = 1.5, there 16.7 % below that at 1.3" in cause
