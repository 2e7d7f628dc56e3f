"""Rules of D1 to D4 on made-up grids."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import change, grid, results

CRACK = (40, 50, 60)
FIELDS = ("u_x", "u_y", "stress_xx", "stress_yy", "stress_xy")

PROPAGATION = grid(
    "mode2", CRACK, G1_error=lambda h, n: 0.02 if (h, n) == (1.3, 40) else -0.19 * h + 0.001 * (n - 40)
)

PROJECTION = grid("mode2", CRACK, G2_error=lambda h, n: 0.045 - 0.0004 * (n - 40) - 0.01 * (h - 1.3))

NORMS = grid("mode2", CRACK, **{f"{field}_rms": lambda h, n: h / n for field in FIELDS})

PARITY = grid(
    "mode2", CRACK, stress_xx_parity_defect_ahead=0.2, stress_yy_parity_defect_ahead=lambda h, n: h
)


def every(rows, **metrics):
    """The rows with these metrics replaced in all cells."""
    return [row | {name: value(row["h"], row["n"]) for name, value in metrics.items()} for row in rows]


def alike_at_60(h, n):
    """G2's error varies by 0.6 % over h̃ at n = 40 and 50, by 0.06 % at 60."""
    return 0.031 - 0.001 * (h - 1.3) if n == 60 else 0.045 - 0.0004 * (n - 40) - 0.01 * (h - 1.3)


def at_1_5(h, n):
    """Smallest at h̃ = 1.5."""
    return (1.0 + abs(h - 1.5)) / n


SYMMETRIC = grid("mode2", CRACK, stress_xx_parity_defect_ahead=0.01, stress_yy_parity_defect_ahead=0.01)

CASES = [
    ("D1", PROPAGATION, REPRODUCED),
    ("D1", change(PROPAGATION, 1.3, 40, G1_error=-0.02), PARTLY),
    ("D1", change(PROPAGATION, 1.3, 40, G1_error=0.24), PARTLY),
    ("D1", change(PROPAGATION, 1.3, 60, G1_error=-0.1), PARTLY),
    ("D1", every(PROPAGATION, G1_error=lambda h, n: -0.1 * h / n), PARTLY),
    ("D1", change(PROPAGATION, 1.9, 60, G1_error=-0.39), NOT),
    ("D1", change(PROPAGATION, 1.5, 50, G1_error=-0.2), NOT),
    ("D2", PROJECTION, REPRODUCED),
    ("D2", change(PROJECTION, 1.3, 40, G2_error=0.05), PARTLY),
    ("D2", every(PROJECTION, G2_error=lambda h, n: 0.04 - 2e-4 * (n - 40) - 0.001 * h), PARTLY),
    ("D2", change(PROJECTION, 1.9, 60, G2_error=0.04), NOT),
    ("D2", change(PROJECTION, 1.3, 60, G2_error=-0.04), NOT),
    ("D2", change(PROJECTION, 1.5, 50, G2_error=0.0301), NOT),
    ("D2", change(PROJECTION, 1.7, 60, G2_error=0.03), NOT),
    ("D2", every(PROJECTION, G2_error=alike_at_60), PARTLY),
    ("D3", NORMS, REPRODUCED),
    ("D3", every(NORMS, u_x_rms=at_1_5, u_y_rms=at_1_5), PARTLY),
    ("D3", every(NORMS, u_x_rms=at_1_5, u_y_rms=at_1_5, stress_xx_rms=at_1_5), NOT),
    ("D3", change(NORMS, 1.7, 60, stress_xy_rms=1.0), NOT),
    ("D4", PARITY, REPRODUCED),
    ("D4", change(PARITY, 1.7, 60, stress_xx_parity_defect_ahead=0.09), PARTLY),
    ("D4", change(PARITY, 1.7, 60, stress_yy_parity_defect_ahead=0.01), PARTLY),
    ("D4", SYMMETRIC, NOT),
]


@pytest.mark.parametrize(("id", "rows", "verdict"), CASES)
def test_verdict(id, rows, verdict):
    finding = find(id).check(results("mode2", rows))
    assert finding.verdict == verdict, finding
    assert finding.numbers


@pytest.mark.parametrize(
    ("id", "rows"), [("D1", PROPAGATION), ("D2", PROJECTION), ("D3", NORMS), ("D4", PARITY)]
)
def test_one_missing_cell_leaves_the_claim_open(id, rows):
    finding = find(id).check(results("mode2", rows[1:]))
    assert finding.verdict == UNKNOWN
    assert "(40, 1.3)" in finding.numbers


def test_what_load_and_artificial_stress_do_to_the_antisymmetry_is_told():
    point = {"block": "mode2", "h": 1.7, "n": 40, "scene.K": 35.8, "method.artificial_stress": 0.0}
    rows = [point | {f"stress_{c}_parity_defect_ahead": 0.01 for c in ("xx", "yy")}]
    made = results("mode2", PARITY, conjectures=results("conjectures", rows))
    told = find("D4").check(made).numbers
    assert told.endswith(
        "σxx and σyy at (40, 1.7): a thousandth of the load, without artificial stress 1 % and 1 %"
    )


def test_norms_that_are_lower_elsewhere_are_told():
    cause = find("D3").check(results("mode2", every(NORMS, u_x_rms=at_1_5, u_y_rms=at_1_5))).cause
    assert "u_y at n = 60: h̃ = 1.5, there 16.7 % below that at 1.3" in cause
