"""Rules of H2 to H6 on made-up points."""

import pytest

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, UNKNOWN, find
from tests.support.results import results

H = (1.3, 1.5, 1.7)


def block(name, metric, values, status="done", **settings):
    """Points at the three h̃ of a block."""
    return [
        {"block": name, "h": h, metric: value, "status": status, **settings}
        for h, value in zip(H, values, strict=True)
    ]


def check(id, *blocks):
    return find(id).check(results("stability", [row for rows in blocks for row in rows])).verdict


def bars(name, values, strain=0.01, metric="stress_share"):
    return block(name, metric, values, **{"scene.strain": strain})


@pytest.mark.parametrize(
    ("left", "total", "verdict"),
    [
        ((0.1, 0.05, 0.95), (1.0, 1.0, 1.0), REPRODUCED),
        ((0.6, 0.05, 0.95), (1.0, 1.0, 1.0), PARTLY),
        ((0.6, 0.7, 0.1), (1.0, 1.0, 1.0), NOT),
        ((0.1, 0.05, 0.95), (0.4, 0.4, 0.4), NOT),
    ],
)
def test_held_bar(left, total, verdict):
    assert check("H2", bars("tension", left), bars("tension_tl", total)) == verdict
    lost = bars("tension", left)
    lost[0]["status"] = "failed"
    assert check("H2", lost, bars("tension_tl", total)) == UNKNOWN


@pytest.mark.parametrize(
    ("plain", "jaumann", "total", "verdict"),
    [
        (1.0, 0.01, 1e-15, REPRODUCED),
        (1.0, 1.0, 1e-15, PARTLY),
        (0.1, 0.01, 1e-15, NOT),
        (1.0, 0.01, 1e-3, NOT),
    ],
)
def test_rotation(plain, jaumann, total, verdict):
    drifts = (("spin", plain), ("spin_jaumann", jaumann), ("spin_tl", total))
    blocks = [block(name, "angular_momentum_drift", (v, v, v)) for name, v in drifts]
    assert check("H3", *blocks) == verdict


@pytest.mark.parametrize(
    ("stretched", "pressed", "verdict"),
    [
        ((0.1, 0.5, 0.99), (0.99, 0.9, 0.1), REPRODUCED),
        ((0.1, 0.5, 0.1), (0.99, 0.9, 0.1), PARTLY),
        ((0.1, 0.5, 0.99), (0.5, 0.9, 0.1), PARTLY),
        ((0.99, 0.5, 0.1), (0.99, 0.9, 0.1), NOT),
    ],
)
def test_sign_of_curvature(stretched, pressed, verdict):
    blocks = (
        bars("tension", stretched, 0.05, "spacing_smallest"),
        bars("compression", pressed, -0.05, "spacing_smallest"),
    )
    assert check("H4", *blocks) == verdict


@pytest.mark.parametrize(
    ("without", "with_it", "verdict"),
    [
        (("diverged",) * 3, "done", REPRODUCED),
        (("diverged", "done", "done"), "done", PARTLY),
        (("done",) * 3, "done", NOT),
        (("diverged",) * 3, "diverged", NOT),
        (("diverged", "missing", "diverged"), "done", UNKNOWN),
    ],
)
def test_heun(without, with_it, verdict):
    rows = [{"block": "no_viscosity", "h": h, "status": s} for h, s in zip(H, without, strict=True)]
    assert check("H5", rows, block("viscosity", "frequency", (1.0, 1.0, 1.0), with_it)) == verdict


@pytest.mark.parametrize(
    ("thesis", "repaired", "total", "verdict"),
    [
        ((400, 900), (0, 600), (0, 0), REPRODUCED),
        ((400, 900), (4, 600), (0, 0), PARTLY),
        ((0, 900), (0, 600), (0, 0), NOT),
        ((400, 900), (0, 600), (0, 1), NOT),
    ],
)
def test_rings(thesis, repaired, total, verdict):
    rows = [
        {"block": name, "h": 1.5, "broken_bonds": bonds, "scene.speed": speed, "scene.nu": 0.3975}
        for name, both in (("rings", thesis), ("rings_repaired", repaired), ("rings_tl", total))
        for speed, bonds in zip((0.06, 0.12), both, strict=True)
    ]
    assert check("H6", rows) == verdict
