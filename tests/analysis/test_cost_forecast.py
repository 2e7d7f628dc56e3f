"""Predicted CPU time, from measurements made up by a known law."""

import json
import time
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from sphstudy.analysis.cost_forecast import ENOUGH, Measurement, Rates, prospect, rates
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


def measured(config, factor=1.0):
    work, _ = prospect(config)
    s, n, m = work.steps, work.particles, work.neighbours
    terms = np.array([1.0, s * n, s * n * m, s * n * m**2, s * n**2 * m])
    seconds = factor * float(FACTORS[config.solve.name] @ terms)
    return Measurement(identity.key(config), config, work, seconds)


def alike(one):
    return one.config.method.name, one.config.solve.name, one.config.scene.name


def test_each_run_is_predicted_by_the_others(configs):
    """To a few times its cost, and nearly in the order in which they should begin."""
    runs = [measured(config) for config in configs]
    found = Rates(runs)
    predicted = np.array([found.seconds(m.config, m.work, without=m.name) for m in runs])
    taken = np.array([m.cpu_seconds for m in runs])
    ratios = predicted / taken
    assert 0.2 < min(ratios) < max(ratios) < 4.0
    assert np.mean(abs(ratios - 1.0) < 0.5) > 0.6
    assert stats.spearmanr(predicted, taken).statistic > 0.95
    # So that what a study costs in all is told well.
    assert predicted.sum() == pytest.approx(taken.sum(), rel=0.1)


def test_one_run_is_scaled_by_the_solvers_own_measure(configs):
    small, large = (c for c in configs if c.solve.name == "modes" and c.h == 1.3 and c.n in (9, 41))
    one = measured(small)
    work, _ = prospect(large)
    cost = solver_module("modes").cost
    grown = cost(*_sizes(work)) / cost(*_sizes(one.work))
    assert Rates([one]).seconds(large, work) == pytest.approx(grown * one.cpu_seconds, rel=1e-6)


def test_without_any_run_like_it_the_solvers_constant_counts(configs):
    thesis = next(c for c in configs if c.method.name == "thesis")
    others = [measured(c) for c in configs if c.method.name == "tl"]
    work, _ = prospect(thesis)
    solver = solver_module("explicit")
    assert Rates(others).seconds(thesis, work) == solver.cost(*_sizes(work)) * solver.SECONDS_PER_COST


def test_runs_of_another_method_solver_or_scene_are_ignored(configs):
    runs = [measured(config) for config in configs]
    wanted = next(m for m in runs if m.config.scene.name == "mode1" and m.config.n == 40)
    like = [m for m in runs if alike(m) == alike(wanted)]
    unlike = [measured(m.config, 10.0) for m in runs if alike(m) != alike(wanted)]
    assert len(unlike) > 5 * len(like)
    predicted = Rates([*unlike, *like]).seconds(wanted.config, wanted.work)
    assert predicted == Rates(like).seconds(wanted.config, wanted.work)


def test_a_large_study_is_predicted_at_once(configs):
    """20 000 points, from as many measurements as are read at most."""
    runs = [measured(config) for config in configs]
    found = Rates(
        replace(m, name=f"{m.name}-{copy}") for m in runs for copy in range(2 * ENOUGH // len(runs))
    )
    wanted = runs[0]
    begun = time.process_time()
    for _ in range(2000):
        found.seconds(wanted.config, wanted.work, without=wanted.name)
    assert time.process_time() - begun < 1.0


def test_only_runs_that_are_done_and_of_this_code_are_learnt_from(configs, tmp_path):
    store, done = Store(tmp_path), configs[0]
    here = provenance()["processor"]
    for config, status, version, processor in (
        (done, "done", identity.numerics_version(done), here),
        (configs[1], "done", "older", here),
        (configs[2], "diverged", identity.numerics_version(configs[2]), here),
        (configs[3], "done", identity.numerics_version(configs[3]), "another"),
    ):
        cost = {k: Metric(v, "1", k) for k, v in (("cpu_seconds", 2.0), ("steps", 10), ("particles", 99))}
        attributes = {
            "title": "made up",
            "key": identity.key(config),
            "date_created": "2026-01-01T00:00:00Z",
            "configuration": json.dumps(config.as_dict()),
            "numerics_version": version,
            "processor": processor,
        }
        run = record.with_outcome(xr.Dataset(), status, "", cost, attributes)
        write(run, store.record_path(config))
    (store.runs / "broken.nc").write_text("no record")
    (one,) = rates(store).measurements
    assert one.name == store.record_path(done).name
    assert (one.config, one.cpu_seconds) == (done, 2.0)
    assert (one.work.steps, one.work.particles) == (10.0, 99.0)


def _sizes(work):
    return work.particles, work.neighbours, work.steps
