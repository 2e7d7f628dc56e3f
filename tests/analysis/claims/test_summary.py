"""Rules of S1 and S2 on made-up studies."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import change, grid, results

PLATE, CRACK = (9, 15, 21), (40, 50, 60)
FIELDS = ("u_x", "u_y", "stress_xx", "stress_yy", "stress_xy")


def near_1_5(h, n):
    return 0.05 * (1.0 + abs(h - 1.5))


def near_1_9(h, n):
    """Ten times worse at h̃ = 1.5 than at 1.9."""
    return 0.5 if h < 1.8 else 0.05


def plate(metric=near_1_5, artificial=(-0.06, 0.2), roughness=0.01, disturbed=PLATE):
    """artificial: frequency error and roughness with artificial stress, where it disturbs."""
    rows = grid(
        "plate",
        PLATE,
        frequency_error=lambda h, n: -metric(h, n),
        amplitude_error=metric,
        stress_roughness_bottom=roughness,
    )
    error, rough = artificial
    point = {"block": "artificial", "scene": "plate", "h": 1.5, "frequency_error": error}
    treated = [
        point | {"n": n, "stress_roughness_bottom": rough if n in disturbed else roughness} for n in PLATE
    ]
    return results("plate", rows + treated)


def crack(mode, metric=near_1_5, ratio=10.0, exception=None):
    rows = grid(
        mode,
        CRACK,
        G2_error=0.04,
        G1_error=-0.04 * ratio,
        **{f"{field}_rms": metric for field in FIELDS},
    )
    return results(mode, change(rows, 1.3, 50, G1_error=exception) if exception else rows)


def thesis(plate_metric=near_1_5, norms=near_1_5, ratio=10.0, exception=None, **others):
    return results(
        "thesis",
        [],
        plate=plate(plate_metric),
        mode1=crack("mode1", norms),
        mode2=crack("mode2", norms, ratio, exception),
        **others,
    )


@pytest.mark.parametrize(
    ("made", "verdict"),
    [
        (thesis(), REPRODUCED),
        (thesis(plate_metric=near_1_9), PARTLY),
        (thesis(ratio=1.0), PARTLY),
        (thesis(exception=0.01), PARTLY),
        (thesis(plate_metric=near_1_9, exception=0.01), PARTLY),
        (thesis(plate_metric=near_1_9, ratio=1.0), NOT),
        (thesis(norms=near_1_9, exception=0.01), NOT),
    ],
)
def test_recommendations(made, verdict):
    finding = find("S1").check(made)
    assert finding.verdict == verdict, finding
    assert bool(finding.cause) == (verdict != REPRODUCED)


def test_measures_are_counted_by_size_whatever_the_sign():
    told = find("S1").check(thesis(plate_metric=near_1_9)).numbers
    assert "good in 12 of 14 measures" in told


def test_a_negligible_error_is_good_enough():
    made = thesis(plate_metric=lambda h, n: near_1_9(h, n) / 100.0)
    assert find("S1").check(made).verdict == REPRODUCED


def test_cells_where_propagation_comes_close_are_named():
    assert "mode2: G1 comes closer than a factor of 3 at (50, 1.3)" in (
        find("S1").check(thesis(exception=0.01)).cause
    )


@pytest.mark.parametrize(
    ("made", "verdict"),
    [
        (plate(), REPRODUCED),
        (plate(disturbed=(21,)), REPRODUCED),
        (plate(artificial=(-0.01, 0.2)), PARTLY),
        (plate(artificial=(-0.06, 0.02)), PARTLY),
        (plate(roughness=0.3), PARTLY),
        (plate(artificial=(-0.01, 0.02)), NOT),
    ],
)
def test_treatment(made, verdict):
    assert find("S2").check(results("thesis", [], plate=made)).verdict == verdict


def test_treatment_tells_what_it_does_to_the_unstable_plate():
    point = {"block": "plate", "h": 1.3, "n": 15, "scene.H0": 0.02, "method.kernel": "cubic"}
    rows = [
        point | {"method.artificial_stress": z, "frequency_error": e, "stress_roughness_bottom": r}
        for z, e, r in ((0.0, -0.12, 0.26), (0.3, -0.08, 0.03))
    ]
    made = results("thesis", [], plate=plate(), conjectures=results("conjectures", rows))
    assert (
        "ω error −8 % instead of −12 %, roughness 3 % instead of 26 %" in find("S2").check(made).numbers
    )


@pytest.mark.parametrize("id", ["S1", "S2"])
def test_one_study_missing_leaves_the_claim_open(id):
    made = results("thesis", [], mode1=crack("mode1"), mode2=crack("mode2"))
    assert find(id).check(made).verdict == UNKNOWN
