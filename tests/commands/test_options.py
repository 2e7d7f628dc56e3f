"""Every choice of a method is an option that does something, and what the skin does not do."""

import numpy as np
import pytest

import sphstudy
from sphstudy.store.record import STATUS

CRACK = {
    "scene": "mode2",
    "n": 16,
    "solve.load_steps": 600,
    "solve.settle_steps": 300,
    "solve.extend_steps": 200,
}
PLATE = {"scene": "plate", "n": 5, "scene.periods": 0.3}
TOTAL = {"scene": "mode2", "method": "tl", "n": 16, "solve.load_steps": 100, "solve.settle_steps": 50}

OPTIONS = [
    (TOTAL, {"method.hourglass": 0.5}),
    (TOTAL, {"method.damping": 100.0}),
    (TOTAL, {"solve.courant": 0.4}),
    (TOTAL, {"solve.time_step": "frequency"}),
    ({**TOTAL, "solve.time_step": "frequency"}, {"solve.safety": 0.5}),
    (CRACK, {"method.bulk_modulus": "primed"}),
    (CRACK, {"method.constrained_smoothing": "free"}),
    (CRACK, {"method.visibility": "exclusive"}),
    (CRACK, {"method.artificial_exponent": 2}),
    (CRACK, {"method.artificial_stress": 0.2}),
    (CRACK, {"method.viscosity_linear": 0.5}),
    (CRACK, {"method.viscosity_quadratic": 1.0}),
    (CRACK, {"method.xsph": 0.4}),
    (CRACK, {"method.damping": 0.5}),
    (CRACK, {"method.smoothing": 0.5}),
    (CRACK, {"solve.courant": 0.08}),
    (CRACK, {"solve.load_time": 0.1}),
    (CRACK, {"solve.settle_ratio": 0.9}),
    (CRACK, {"scene.frame_layers": 1}),
    (CRACK, {"scene.energy_constants": "primed"}),
    (PLATE, {"scene.columns": "spacing"}),
    (PLATE, {"scene.plane": "stress"}),
    (PLATE, {"scene.clamped_columns": 2}),
    (PLATE, {"scene.slenderness": 10}),
    (PLATE, {"scene.H0": 0.03}),
]
SLOW_OPTIONS = [
    (TOTAL, {"method.kernel": "wendland"}),
    (TOTAL, {"method.law": "svk"}),
    (TOTAL, {"method.viscosity_linear": 1.0}),
    ({**TOTAL, "method.viscosity_linear": 1.0, "solve.courant": 0.3}, {"solve.integrator": "heun"}),
    (CRACK, {"method.retest_visibility": False}),
    (CRACK, {"method.artificial_stress": 0.0}),
    (CRACK, {"method.smoothing": 0.0, "method.damping": 0.0}),
    (PLATE, {"method.xsph": 0.0}),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("options")


def effect(folder, base, option):
    """Largest relative change of a metric of the run by the option."""
    plain, changed = (sphstudy.run(results=folder, **{**base, **extra}) for extra in ({}, option))
    assert int(changed["status"]) == 1, changed.attrs["message"]
    names = [n for n, v in plain.items() if v.attrs.get("group") == "metric" and n in changed]
    pairs = [(float(plain[n]), float(changed[n])) for n in names]
    return max(abs(b - a) / max(abs(a), 1e-12) for a, b in pairs if np.isfinite(a) and np.isfinite(b))


@pytest.mark.parametrize(("base", "option"), OPTIONS, ids=[" ".join(o) for _, o in OPTIONS])
def test_every_option_has_an_effect(folder, base, option):
    assert effect(folder, base, option) > 1e-4


@pytest.mark.slow
@pytest.mark.parametrize(("base", "option"), SLOW_OPTIONS, ids=[" ".join(o) for _, o in SLOW_OPTIONS])
def test_every_option_that_compiles_anew_has_an_effect(folder, base, option):
    assert effect(folder, base, option) > 1e-4


@pytest.mark.slow
def test_without_viscosity_the_plate_blows_up(folder):
    """Undamped, Heun's method lives by the artificial viscosity: switched off, it ends as diverged."""
    inviscid = {"method.viscosity_linear": 0.0, "method.viscosity_quadratic": 0.0}
    run = sphstudy.run(results=folder, **PLATE, **inviscid)
    assert STATUS[int(run["status"])] == "diverged"
    assert "stage vibrate" in run.attrs["message"]


def test_prescribing_again_matters_where_constrained_particles_are_smoothed(folder):
    free = {**CRACK, "method.constrained_smoothing": "free"}
    assert effect(folder, free, {"method.prescribe_again": False}) > 1e-4


def test_the_skin_is_a_matter_of_speed_only(folder):
    thin, thick = (sphstudy.run(results=folder, **CRACK, **{"method.skin": skin}) for skin in (0.05, 0.4))
    for name in ("G1", "G2", "u_x_rms", "stress_xy_rms"):
        assert float(thin[name]) == pytest.approx(float(thick[name]), rel=1e-9)
