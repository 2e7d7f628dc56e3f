"""The command advise, on a dataset made up without running anything."""

import json

import numpy as np
import pytest
import xarray as xr

from sphstudy.__main__ import main
from sphstudy.configuration.composition import session
from sphstudy.store.netcdf import write
from sphstudy.store.record import STATUS, status_variable

MODES = ["scene=plate", "method=tl", "solve=modes", "h=1.3", "n=9,15,21"]
STEPPED = [
    "scene=plate",
    "method=thesis",
    "solve.courant=0.4",
    "h=1.5",
    "n=9,15",
    "record.times=[0.1,0.2]",
]
ERRORS = [-0.016, -0.004, -0.001, -0.15, np.nan]
SECONDS = [0.1, 0.2, 0.5, 3.0, 0.01]
OUTCOMES = ["done", "done", "done", "done", "diverged"]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """A folder with a dataset of the study `precision`: three points of one series, two of another."""
    with session() as hydra:
        configs = [p.config for grid in (MODES, STEPPED) for p in hydra.points(grid, sweep=True)[0]]
    metric = {"units": "1", "group": "metric", "long_name": "error of ω"}
    numbers = {
        "frequency_error_2d": ERRORS,
        "cpu_seconds": SECONDS,
        "compile_seconds": [7.0, 0.0, 0.0, 0.0, 0.0],
        "spacing": [1.0 / c.n for c in configs],
    }
    dataset = xr.Dataset(
        {name: ("point", np.array(values), metric) for name, values in numbers.items()},
        {"h": ("point", [c.h for c in configs]), "n": ("point", [c.n for c in configs])},
    )
    dataset["status"] = status_variable(("point",), [STATUS.index(one) for one in OUTCOMES])
    dataset["configuration"] = ("point", np.array([json.dumps(c.as_dict()) for c in configs], object))
    folder = tmp_path_factory.mktemp("results")
    write(dataset, folder / "sweeps" / "precision.nc")
    return folder


def test_the_cheapest_with_the_points_it_rests_on(results, capsys):
    assert main(["advise", "scene=plate", "error=1%", f"results={results}"]) == 0
    shown = capsys.readouterr().out
    assert "  sphstudy scene=plate method=tl solve=modes h=1.3 n=15\n" in shown
    assert "error −0.40 %, 0.20 s of CPU time measured" in shown
    assert "confirmed: n=21" in shown
    lines = {line.partition("  ")[0].strip(): line for line in shown.splitlines()}
    assert "n=9" in lines["best of cheaper ones"]
    assert "n=21" in lines["next finer"]
    assert "at most 7 s" in shown


def test_a_share_is_as_good_as_a_percentage(results, capsys):
    answers = []
    for error in ("1%", "0.01", "1e-2"):
        main(["advise", "scene=plate", f"error={error}", f"results={results}"])
        answers.append(capsys.readouterr().out)
    assert len(set(answers)) == 1


def test_the_command_makes_the_same_run(results, capsys):
    assert main(["advise", "scene=plate", "error=20%", "method=thesis", f"results={results}"]) == 0
    shown = capsys.readouterr().out
    words = "sphstudy scene=plate method=thesis solve=explicit h=1.5 n=9 solve.courant=0.4"
    assert f"  {words} 'record.times=[0.1, 0.2]'\n" in shown
    assert "not confirmed: there is no finer resolution" in shown


def test_what_is_out_of_reach_is_said_and_extrapolated(results, capsys):
    assert main(["advise", "scene=plate", "error=0.05%", f"results={results}"]) == 1
    shown = capsys.readouterr().out
    assert "no point reaches it" in shown
    assert "h=1.3 n=21\n" in shown
    assert "Richardson extrapolation" in shown
    assert "n=9,15,21" in shown


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["error=1%"], "advise: scene lacking"),
        (["scene=plate"], "advise: error lacking"),
        (["scene=ring", "error=1%"], "scene=ring: in study precision is plate"),
        (["scene=plate", "error=-1"], "error=-1: should be a positive number"),
        (["scene=plate", "error=abc"], "error=abc: should be a positive number"),
        (["scene=plate", "error=nan"], "error=nan: should be a positive number"),
        (["scene=plate", "error=1%", "error=2%"], "error: is given twice"),
        (["scene=plate", "error=1%", "h=1.3"], "h=1.3: unknown option of advise 'h'; there are error"),
        (["scene=plate", "error=1%", "method=sph"], "method=sph: in study precision is tl, thesis"),
        (["scene=plate", "error=1%", "metric=no"], "scene=plate metric=no: study precision has no point"),
        (["scene=plate", "error=1%", "study=no"], "unknown study 'no'; there are"),
        (["scene=plate", "error=1%", "study=plate"], "run study plate first"),
    ],
)
def test_wrong_input_is_answered_in_a_line(arguments, complaint, results, capsys):
    assert main(["advise", *arguments, f"results={results}"]) == 2
    shown = capsys.readouterr().err
    assert complaint in shown
    assert shown.count("\n") == 1
