"""Predicted CPU time, from measurements made up by a known law."""

import dataclasses
import json

import numpy as np
import pytest
import xarray as xr

from sphstudy.analysis.cost_forecast import Measurement, Rates, prospect, rates
from sphstudy.catalogue import solver_module
from sphstudy.configuration.composition import session
from sphstudy.metrics.metric import Metric
from sphstudy.store import identity, record
from sphstudy.store.netcdf import write
from sphstudy.store.provenance import provenance
from sphstudy.store.store import Store

FACTORS = {
    "explicit": np.array([0.1, 2e-8, 5e-9, 0.0, 0.0]),
    "modes": np.array([0.05, 1e-6, 0.0, 5e-8, 3e-10]),
    "equilibrium": np.array([0.03, 0.0, 1e-6, 2e-8, 1e-10]),
}


@pytest.fixture(scope="module")
def configs():
    """Points of several scenes, methods, solvers and sizes."""
    grids = [
        ["scene=plate", "method=thesis,tl", "h=1.3,1.5,1.9", "n=9,15,21"],
        ["scene=plate", "method=tl", "solve=modes", "h=1.3,1.5,1.9", "n=9,15,21,41"],
        ["scene=bending", "method=tl", "solve=equilibrium", "h=1.3,1.5,1.9", "n=9,15,21,41"],
        ["scene=mode1", "method=tl", "solve=equilibrium", "h=1.3,1.9", "n=20,40"],
    ]
    with session() as hydra:
        return [point.config for grid in grids for point in hydra.points(grid, sweep=True)[0]]


def measured(config, factor=1.0, **changes):
    work, _ = prospect(config)
    seconds = factor * float(FACTORS[config.solve.name] @ work.terms)
    return dataclasses.replace(Measurement(identity.key(config), config.flat(), work, seconds), **changes)


def test_each_run_is_predicted_by_the_others(configs):
    found = Rates(tuple(map(measured, configs))).left_out()
    ratios = np.array([predicted / taken for predicted, taken in found.values()])
    assert len(ratios) == len(configs)
    assert np.mean(abs(ratios - 1.0) < 0.3) > 0.9
    assert np.median(abs(ratios - 1.0)) < 0.03


def test_one_run_is_scaled_by_the_solvers_own_measure(configs):
    small, large = (c for c in configs if c.solve.name == "modes" and c.h == 1.3 and c.n in (9, 41))
    one = measured(small)
    work, _ = prospect(large)
    cost = solver_module("modes").cost
    grown = cost(*_sizes(work)) / cost(*_sizes(one.work))
    assert Rates((one,)).seconds(large, work) == pytest.approx(grown * one.cpu_seconds, rel=1e-6)


def test_without_any_run_like_it_the_solvers_constant_counts(configs):
    thesis = next(c for c in configs if c.method.name == "thesis")
    others = tuple(measured(c) for c in configs if c.method.name == "tl")
    work, _ = prospect(thesis)
    solver = solver_module("explicit")
    assert Rates(others).seconds(thesis, work) == solver.cost(*_sizes(work)) * solver.SECONDS_PER_COST


def test_runs_of_the_same_scene_code_and_settings_count_most(configs):
    chosen = [c for c in configs if c.solve.name == "equilibrium"]
    wanted = next(c for c in chosen if c.scene.name == "mode1" and c.n == 40)
    name, own = identity.key(wanted), measured(wanted)
    near = [measured(c) for c in chosen if c.scene.name == "mode1"]
    wrong = [
        *(measured(c, 10.0) for c in chosen if c.scene.name == "bending"),
        *(measured(c, 10.0, name="old", foreign=True) for c in chosen if c.scene.name == "mode1"),
    ]
    predicted = Rates((*near, *wrong)).seconds(wanted, own.work, without=name)
    # The others, all ten times as slow, are in the majority.
    assert len(wrong) > 5 * (len(near) - 1)
    assert 0.5 < predicted / own.cpu_seconds < 2.0


def test_only_runs_that_are_done_and_of_this_code_are_learnt_from(configs, tmp_path):
    store, done = Store(tmp_path), configs[0]
    for config, status, version in (
        (done, "done", identity.numerics_version(done)),
        (configs[1], "done", "older"),
        (configs[2], "diverged", identity.numerics_version(configs[2])),
    ):
        cost = {k: Metric(v, "1", k) for k, v in (("cpu_seconds", 2.0), ("steps", 10), ("particles", 99))}
        attributes = {
            "title": "made up",
            "key": identity.key(config),
            "date_created": "2026-01-01T00:00:00Z",
            "configuration": json.dumps(config.as_dict()),
            "numerics_version": version,
            "processor": provenance()["processor"],
        }
        run = record.with_outcome(xr.Dataset(), status, "", cost, attributes)
        write(run, store.record_path(config))
    (store.runs / "broken.nc").write_text("no record")
    found = {m.name: m for m in rates(store).measurements}
    assert set(found) == {store.record_path(c).name for c in configs[:2]}
    one = found[store.record_path(done).name]
    assert (one.foreign, one.cpu_seconds, one.work.steps, one.work.particles) == (False, 2.0, 10.0, 99.0)
    assert found[store.record_path(configs[1]).name].foreign


def _sizes(work):
    return work.particles, work.neighbours, work.steps
