"""Limits at which a run stops, and what a run that goes bad keeps."""

from types import SimpleNamespace

import numpy as np
import pytest

from sphstudy.numerics.solvers.checkpoint import NoKeeper
from sphstudy.numerics.solvers.limits import breached, energy_gain
from sphstudy.numerics.solvers.solution import HISTORY, LAST_GOOD
from tests.numerics.solvers.test_checkpoint import solved

NONE = {f"stop_{name}": None for name in ("energy_gain", "spacing", "hourglass", "mirror")}


def row(**values):
    return tuple(float(values.get(name, np.nan)) for name in HISTORY)


def energies(*rows):
    names = ("time", "kinetic_energy", "strain_energy", "constraint_power")
    return [row(**dict(zip(names, values, strict=True))) for values in rows]


def test_energy_gain_counts_what_constraints_put_in():
    # 2 J at first, 3 J put in by a power that falls from 6 to 0 W in a second.
    honest = energies((0, 2, 0, 6), (1, 1, 4, 0))
    assert energy_gain(honest) == pytest.approx(0.0)
    assert energy_gain(energies((0, 2, 0, 6), (1, 2, 4, 0))) == pytest.approx(1.0 / 6.0)
    assert energy_gain(energies((0, 2, 0, 6), (1, 0, 4, 0))) == pytest.approx(-1.0 / 5.0)
    assert energy_gain(energies((0, 0, 0, 0))) == 0.0


@pytest.mark.parametrize(
    ("limit", "value", "sample", "words"),
    [
        ("stop_spacing", 0.5, {"smallest_spacing": 0.04}, "0.4 spacings apart"),
        ("stop_hourglass", 0.5, {"hourglass_share": 0.6}, "checkerboard share of 0.6"),
        ("stop_mirror", 0.5, {"mirror_defect": 0.7}, "mirror defect of 0.7"),
    ],
)
def test_each_limit_is_named_when_broken_and_silent_when_not(limit, value, sample, words):
    history = [row(**sample)]
    assert words in breached(history, 0.1, SimpleNamespace(**NONE | {limit: value}))
    assert breached(history, 0.1, SimpleNamespace(**NONE)) == ""
    assert breached([row(smallest_spacing=0.06)], 0.1, SimpleNamespace(**NONE | {limit: value})) == ""


BLOW_UP = ["scene=plate", "n=5", "scene.periods=0.3", "solve.courant=3", "record.samples=300"]


@pytest.mark.parametrize("method", ["thesis", "tl"])
def test_a_run_that_goes_bad_keeps_its_last_good_state(method):
    solution = solved([*BLOW_UP, f"method={method}"], NoKeeper())
    assert solution.outcome == "diverged"
    (good,) = solution.snapshots
    history = np.array(solution.history)
    assert good.label == LAST_GOOD
    assert good.step in history[:, HISTORY.index("step")]
    assert 0 <= solution.steps - good.step <= 100
    assert np.isfinite(good.fields).all()
    fastest = np.hypot(good.fields[2], good.fields[3]).max()
    assert fastest < np.sqrt(1e6 / 1.2 / 7750.0), "faster than sound is not good"


def test_a_run_stops_at_the_limit_that_it_was_given():
    plate = ["scene=plate", "n=5", "method=thesis", "scene.periods=0.3", "record.samples=50"]
    whole = solved(plate, NoKeeper())
    closest = np.array(whole.history)[:, HISTORY.index("smallest_spacing")] * 60.0
    limit = 0.5 * (closest[0] + closest.min())
    first = int(np.argmax(closest < limit))
    stopped = solved([*plate, f"solve.stop_spacing={limit:.12g}"], NoKeeper())
    assert stopped.outcome == "diverged"
    assert f"limit {limit:g}" in stopped.message
    assert len(stopped.history) == first + 1
    assert stopped.steps == int(np.array(whole.history)[first, HISTORY.index("step")])
