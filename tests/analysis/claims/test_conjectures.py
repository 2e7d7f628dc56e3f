"""Rules of K1 to K3 on made-up points."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from sphstudy.analysis.claims.tensile_instability import FULL, THOUSANDTH, curvature_at_neighbour
from tests.support.results import results

KERNELS = ("cubic", "wendland", "quintic")


def plate(spiked=0.3, unloaded=0.01, stray=1.0):
    """Roughness that grows with the load where W'' > 0; `stray`: its growth where W'' < 0."""
    rows = []
    for kernel in KERNELS:
        for h in (1.3, 1.7):
            grows = curvature_at_neighbour(h, kernel) > 0.0
            for load in (FULL, THOUSANDTH):
                rough = (spiked if grows else unloaded * stray) if load == FULL else unloaded
                rows.append(
                    {
                        "block": "plate",
                        "h": h,
                        "n": 15,
                        "method.kernel": kernel,
                        "scene.H0": load,
                        "method.artificial_stress": 0.0,
                        "stress_roughness_bottom": rough,
                    }
                )
    return rows


@pytest.mark.parametrize(
    ("rows", "verdict"),
    [
        (plate(), REPRODUCED),
        (plate(stray=40.0), PARTLY),
        (plate(unloaded=0.2), NOT),
        (plate(spiked=0.02), NOT),
        ([], UNKNOWN),
        ([*plate()[:-1], plate()[-1] | {"stress_roughness_bottom": float("nan")}], UNKNOWN),
    ],
)
def test_spikes(rows, verdict):
    finding = find("K1").check(results("conjectures", rows))
    assert finding.verdict == verdict, finding


def bending(below=4.0, above=1.5, unloaded=1.0, stray=0.5):
    """Spread over its value at 11 s, 1 %; `stray`: below over above where W'' > 0."""
    rows = []
    for kernel in ("cubic", "wendland"):
        for h in (1.3, 1.7):
            down, up = below, above
            if curvature_at_neighbour(h, kernel) > 0.0:
                down = above * stray
            rows.append(
                {
                    "block": "bending_kernel",
                    "h": h,
                    "n": 7,
                    "method.kernel": kernel,
                    "spacing_spread_bottom": 0.01 * down,
                    "spacing_spread_top": 0.01 * up,
                }
            )
    rows.append(
        {
            "block": "bending_load",
            "h": 1.7,
            "n": 7,
            "method.kernel": "cubic",
            "spacing_spread_bottom": 0.01 * unloaded,
            "spacing_spread_top": 0.01,
        }
    )
    early = {"spacing_spread_bottom_11s": 0.01, "spacing_spread_top_11s": 0.01}
    return [row | early for row in rows]


@pytest.mark.parametrize(
    ("rows", "verdict"),
    [
        (bending(), REPRODUCED),
        (bending(unloaded=3.0), PARTLY),
        (bending(stray=9.0), PARTLY),
        (bending(unloaded=3.0, stray=9.0), NOT),
        (bending(below=1.2), NOT),
        (bending()[:-1], UNKNOWN),
    ],
)
def test_clumping(rows, verdict):
    finding = find("K2").check(results("conjectures", rows))
    assert finding.verdict == verdict, finding


def mode2(off_xx=0.3, off_yy=0.8, tensile_xx=1.0, tensile_yy=1.0):
    """Parity defects 0.3 and 0.8 with artificial stress; `tensile`: factor on those without at 1.3."""
    rows = []
    for h in (1.3, 1.5, 1.7):
        for stress in (0.0, 0.3):
            for load in (35.8e3, 35.8):
                xx, yy = (0.3, 0.8) if stress else (off_xx, off_yy)
                if h == 1.3 and not stress:
                    xx, yy = xx * tensile_xx, yy * tensile_yy
                rows.append(
                    {
                        "block": "mode2",
                        "h": h,
                        "n": 40,
                        "scene.K": load,
                        "method.artificial_stress": stress,
                        "stress_xx_parity_defect_ahead": xx,
                        "stress_yy_parity_defect_ahead": yy,
                    }
                )
    return rows


@pytest.mark.parametrize(
    ("rows", "verdict"),
    [
        (mode2(), NOT),
        (mode2(off_xx=0.1, off_yy=0.3), REPRODUCED),
        (mode2(off_xx=0.1), PARTLY),
        (mode2(tensile_xx=3.0, tensile_yy=3.0), REPRODUCED),
        (mode2(tensile_yy=3.0), PARTLY),
        ([*mode2()[:-1], mode2()[-1] | {"stress_xx_parity_defect_ahead": float("nan")}], UNKNOWN),
        ([], UNKNOWN),
    ],
)
def test_antisymmetry(rows, verdict):
    finding = find("K3").check(results("conjectures", rows))
    assert finding.verdict == verdict, finding
    assert (finding.cause == "") == (verdict in (REPRODUCED, UNKNOWN))
