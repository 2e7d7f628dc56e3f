"""Stress intensities and energy release rates on synthetic data."""

import json

import numpy as np
import pytest
import xarray as xr

from sphstudy.catalogue import scene_module
from sphstudy.configuration.composition import session
from sphstudy.metrics import fracture, norms
from sphstudy.metrics.bending import column_angle
from sphstudy.model.exact import williams

E, NU, K = 6e6, 0.3, 35.8e3


def crack_record(mode, factor=1.0, energies=(0.0, 0.0, 0.0), closures=(np.nan,) * 4):
    """A record whose displacements and stresses are `factor` times the exact field."""
    with session() as hydra:
        config = hydra.points([f"scene=mode{mode}", "n=20"], sweep=False)[0][0].config
    body = scene_module("crack").build(config).body
    u_x, u_y = williams.displacement(mode, body.x, body.y, factor * K, E, NU)
    stresses = williams.stress(mode, body.x, body.y, factor * K)
    count, labels = body.x.size, ["load", "settle", "extend1", "extend2"]
    fields = {"x": body.x + u_x, "y": body.y + u_y}
    fields |= dict(zip(("stress_xx", "stress_yy", "stress_xy"), stresses, strict=True))
    data = {name: (("snapshot", "particle"), np.tile(v, (4, 1))) for name, v in fields.items()}
    data["snapshot_strain_energy"] = ("snapshot", [0.0, *energies])
    data["snapshot_closure_work"] = ("snapshot", list(closures))
    data["density"] = (("snapshot", "particle"), np.full((4, count), 7750.0))
    data["snapshot_label"] = ("snapshot", labels)
    data["mass"] = ("particle", body.mass)
    data["reference_x"], data["reference_y"] = ("particle", body.x), ("particle", body.y)
    data |= {"spacing_x": body.spacing_x}
    data |= {f"tag_{name}": ("particle", mask.astype(np.int8)) for name, mask in body.tags.items()}
    return xr.Dataset(data, attrs={"configuration": json.dumps(config.as_dict())}), config


@pytest.mark.parametrize("mode", [1, 2])
@pytest.mark.parametrize("factor", [1.0, 0.9])
def test_projection_finds_the_stress_intensity_of_the_field(mode, factor):
    run, config = crack_record(mode, factor)
    found = {name: m.value for name, m in fracture.measure(run, config).items()}
    assert found[f"K_{'I' * mode}_error"] == pytest.approx(factor - 1.0, abs=1e-12)
    assert found[f"K_{'I' * (3 - mode)}"] == pytest.approx(0.0, abs=1e-9 * K)
    assert found["G2_error"] == pytest.approx(factor**2 - 1.0, abs=1e-12)
    assert found["G2_error_free"] == pytest.approx(factor**2 - 1.0, abs=1e-12)


def test_propagation_reads_the_energies_of_the_three_states():
    run, config = crack_record(1, energies=(5.0, 4.7, 4.2))
    found = {name: m.value for name, m in fracture.measure(run, config).items()}
    assert [found[f"U{k}"] for k in range(3)] == pytest.approx([5.0, 4.7, 4.2])
    assert found["G1"] == pytest.approx(-(-1.5 * 5.0 + 2 * 4.7 - 0.5 * 4.2) / 0.01)


def test_closure_extrapolates_the_work_of_two_extensions_as_propagation_does():
    run, config = crack_record(1, energies=(5.0, 4.7, 4.2), closures=(np.nan, np.nan, 0.3, 0.5))
    found = {name: m.value for name, m in fracture.measure(run, config).items()}
    assert found["G_closure"] == pytest.approx(found["G1"], rel=1e-12)


def test_without_forces_of_cut_bonds_there_is_no_closure_estimate():
    run, config = crack_record(1)
    assert "G_closure" not in fracture.measure(run, config)


def test_propagation_is_exact_for_quadratic_energies():
    a, d = 0.1, 0.003
    energy = lambda x: 3.0 - 7.0 * x + 11.0 * x**2  # noqa: E731
    g1 = fracture.propagated_release_rate(energy(a), energy(a + d), energy(a + 2 * d), d)
    assert g1 == pytest.approx(7.0 - 22.0 * a, rel=1e-10)


def test_standard_error_is_that_of_the_noise(rng):
    x0, y0 = -np.linspace(0.002, 0.098, 49), np.full(49, 1e-3)
    exact = williams.displacement(1, x0, y0, K, E, NU)[1]
    fits = [
        fracture.fit_stress_intensity(1, x0, y0, exact + rng.normal(scale=1e-5, size=49), E, NU)
        for _ in range(400)
    ]
    spread = np.std([fit.value for fit in fits])
    assert np.mean([fit.standard_error for fit in fits]) == pytest.approx(spread, rel=0.12)


def test_no_particles_no_fit():
    with pytest.raises(ValueError, match="no particles"):
        fracture.fit_stress_intensity(1, np.empty(0), np.empty(0), np.empty(0), E, NU)


@pytest.mark.parametrize("mode", [1, 2])
def test_norms_of_the_exact_field_are_zero_and_scale_with_its_error(mode):
    exact = {name: m.value for name, m in norms.measure(*crack_record(mode)).items()}
    assert max(exact.values()) < 1e-9
    off = {name: m.value for name, m in norms.measure(*crack_record(mode, 1.1)).items()}
    twice = {name: m.value for name, m in norms.measure(*crack_record(mode, 1.2)).items()}
    for name, value in off.items():
        power = 4.0 if "mean_square" in name else 2.0
        assert twice[name] == pytest.approx(power * value, rel=1e-9)


def test_norms_by_hand():
    found = norms.error_norms([1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 0.0, 0.0])
    assert found == (2.5, 6.25, 1.25)
    with pytest.raises(ValueError, match="no particles"):
        norms.error_norms([], [])


@pytest.mark.parametrize("angle", [-0.06, 0.0, 0.3])
def test_column_angle_is_the_rotation(angle):
    s = np.linspace(-1.0, 1.0, 9)
    assert column_angle(-s * np.sin(angle), s * np.cos(angle)) == pytest.approx(angle, abs=1e-14)
