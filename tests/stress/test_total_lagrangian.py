"""What the total Lagrangian method must hold on the thesis's benchmarks, with the linear law."""

import numpy as np
import pytest

import sphstudy
from sphstudy.analysis.extrapolation import extrapolated

pytestmark = pytest.mark.slow

CRACK = {"method": "tl", "solve": "equilibrium", "h": 1.3, "n": [40, 60]}


@pytest.fixture(scope="module", params=[1, 2])
def crack(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("crack")
    return request.param, sphstudy.sweep(scene=f"mode{request.param}", results=folder, **CRACK).squeeze()


def test_stress_intensity_at_two_resolutions(crack):
    mode, grid = crack
    same, other = ("K_I", "K_II") if mode == 1 else ("K_II", "K_I")
    bounds = (0.0100, 0.0065) if mode == 1 else (0.0095, 0.0062)
    assert (np.abs(grid[f"{same}_integral_error"].values) <= bounds).all()
    assert (np.abs(grid[f"{other}_integral_error"].values) < 1e-6).all()


def test_extrapolated_to_zero_spacing(crack):
    """The tip makes everything first order in Δ."""
    mode, grid = crack
    same = "K_I" if mode == 1 else "K_II"
    for metric, bound in ((f"{same}_integral_error", 5e-4), ("J_error", 8e-4), ("G1_error", 2e-3)):
        value = float(extrapolated(grid.expand_dims("h"), metric, order=1.0)[metric].squeeze())
        assert abs(value) <= bound, metric


def test_closure_is_the_energy_released(crack):
    _, grid = crack
    np.testing.assert_allclose(grid["G_closure_error"], grid["G1_error"], atol=1e-9)


def test_finite_strain_agrees_with_the_linear_law_at_a_thousandth_of_the_load(tmp_path):
    grid = sphstudy.sweep(
        scene="mode1", method="tl", solve="equilibrium", h=1.3, n=40, results=tmp_path,
        **{"scene.K": 35.8, "method.law": ["linear", "svk"]},
    ).squeeze()  # fmt: skip
    for metric in ("K_I_integral_error", "J_error", "G1_error"):
        linear, finite = grid[metric].values
        assert finite == pytest.approx(linear, abs=1e-4)


@pytest.mark.slow
def test_stepping_and_modes_agree(tmp_path):
    grid = sphstudy.sweep(
        scene="plate", method="tl", h=1.3, n=[9, 15, 21], solve=["explicit", "modes"], results=tmp_path
    )["frequency"].squeeze()
    stepped, modal = grid.sel(solve="explicit"), grid.sel(solve="modes")
    np.testing.assert_allclose(stepped, modal, rtol=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["linear", "svk", "neohookean"])
def test_energy_of_twenty_periods(tmp_path, law):
    run = sphstudy.run(
        scene="plate",
        method="tl",
        h=1.3,
        n=9,
        results=tmp_path,
        **{"scene.periods": 20, "method.law": law},
    )
    assert float(run["energy_drift"]) <= 1e-4


@pytest.mark.slow
def test_nothing_clumps_in_160_seconds(tmp_path):
    run = sphstudy.run(
        scene="bending", method="tl", h=1.7, n=9, results=tmp_path,
        **{"scene.end_time": 160, "record.times": [11, 150]},
    )  # fmt: skip
    for part in ("bottom", "top", "rest"):
        early, late = run[f"spacing_smallest_{part}_11s"], run[f"spacing_smallest_{part}"]
        assert float(late) == pytest.approx(float(early), abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "n"), [("bending", 9), ("mode1", 40), ("mode2", 40)])
def test_damped_stepping_ends_at_equilibrium(tmp_path, scene, n):
    grid = sphstudy.sweep(
        scene=scene, method="tl", h=1.3, n=n, solve=["explicit", "equilibrium"], results=tmp_path
    ).squeeze()
    metrics = (
        ("end_angle", "bending_energy_error")
        if scene == "bending"
        else ("U0", "U1", "U2", "J", "G_closure")
    )
    for metric in metrics:
        stepped, solved = grid[metric].values
        assert stepped == pytest.approx(solved, rel=1e-7)
