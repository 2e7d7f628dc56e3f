"""Whole commands on small scenes: runs, sweeps, resumption, blow-ups, failures, wrong input."""

import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import sphstudy
from sphstudy import metrics
from sphstudy.__main__ import main
from sphstudy.running import launching
from sphstudy.store import measured
from sphstudy.store.record import STATUS

SMALL = ["scene=plate", "scene.periods=0.3"]


def command(*arguments, cwd):
    return subprocess.run(
        [sys.executable, "-m", "sphstudy", *arguments],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
    )


def records(folder):
    return {path.name: path for path in (folder / "runs").glob("*.nc")}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A sweep of four points over two processes, overrides before -m."""
    folder = tmp_path_factory.mktemp("sweep")
    result = command(*SMALL, "h=1.5,1.7", "-m", "n=5,7", cwd=folder)
    return folder, result


def test_a_sweep_leaves_a_record_a_point_one_dataset_and_a_table(swept):
    folder, result = swept
    assert result.returncode == 0, result.stderr
    assert len(records(folder / "results")) == 4
    (path,) = (folder / "results" / "sweeps").glob("*.nc")
    with xr.open_dataset(path) as dataset:
        assert dict(dataset.sizes) == {"h": 2, "n": 2}
        assert (dataset["status"] == STATUS.index("done")).all()
        assert np.isfinite(dataset["frequency_error"]).all()
        for name, variable in dataset.variables.items():
            assert variable.attrs["long_name"], name
            assert variable.attrs["units"], name
    for word in ("frequency error", "cpu seconds (s)", "done", str(path.name)):
        assert word in result.stdout
    assert "[4/4]" in result.stderr


def test_what_is_there_is_not_run_again_unless_forced(swept):
    folder, _ = swept
    before = {name: path.stat().st_mtime_ns for name, path in records(folder / "results").items()}
    again = command("-m", *SMALL, "h=1.5,1.7", "n=5,7", cwd=folder)
    assert again.returncode == 0
    assert "[" not in again.stderr
    after = {name: path.stat().st_mtime_ns for name, path in records(folder / "results").items()}
    assert after == before
    more = command("-m", *SMALL, "h=1.5,1.7,1.9", "n=5,7", cwd=folder)
    assert "4 kept from before" in more.stderr
    name, path = next((n, p) for n, p in records(folder / "results").items() if "h1.5-n5" in n)
    with xr.open_dataset(path) as run:
        first = run.load()
    forced = command("--force", *SMALL, "h=1.5", "n=5", cwd=folder)
    assert forced.returncode == 0
    assert path.stat().st_mtime_ns > before[name]
    with xr.open_dataset(path) as run:
        for field in ("x", "y", "velocity_x", "stress_xy", "density", "history_u_y"):
            np.testing.assert_array_equal(run[field], first[field])


def test_status_counts_what_is_there(swept):
    folder, _ = swept
    result = command("status", cwd=folder)
    assert result.returncode == 0
    assert "plate-thesis-h1.5-n5" in result.stdout
    assert "done" in result.stdout.splitlines()[-1]


def test_wrong_input_ends_with_status_two_before_anything_runs(tmp_path):
    result = command("-m", "h=1.3,-1", "n=40", cwd=tmp_path)
    assert result.returncode == 2
    assert result.stderr == "sphstudy: h=-1: should be greater than 0\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["foo"], "unknown command 'foo'; there are run, study"),
        (["-x"], "unknown option of run '-x'; did you mean '-m'?"),
        (["study"], "study: name one of"),
        (["study", "foo"], "unknown study 'foo'; there are"),
        (["status", "results=/nowhere"], "results=/nowhere: there are no runs"),
        (["describe", "foo"], "unknown scene, method or solver 'foo'; there are"),
        (["describe", "scene", "foo"], "unknown scene 'foo'; "),
        (["results=/proc/x"], "results=/proc/x: cannot be written"),
        (["hydra/launcher=foo"], "unknown launcher 'foo'"),
        (
            ["scene=plate", "record.times=[7.0]"],
            "record.times=7: plate-thesis-h1.5-n9 runs from 0 to 6.5",
        ),
    ],
)
def test_wrong_commands_are_answered_in_a_line(arguments, complaint, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert complaint in capsys.readouterr().err


@pytest.mark.parametrize("word", ["--help", "--version", "list"])
def test_asking_is_not_an_error(word, capsys):
    assert main([word]) == 0
    assert capsys.readouterr().out


@pytest.mark.parametrize("name", ["plate", "mode1", "thesis", "explicit"])
def test_describe_shows_every_setting(name, capsys):
    assert main(["describe", name]) == 0
    shown = capsys.readouterr().out
    assert {"plate": "scene.H0", "mode1": "scene.frame_layers"}.get(name, "") in shown
    assert "meaning" in shown


def test_a_diverged_point_is_a_result_and_costs_no_other(tmp_path):
    result = command("-m", *SMALL, "n=5", "solve.courant=0.8,3", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    (path,) = (tmp_path / "results" / "sweeps").glob("*.nc")
    with xr.open_dataset(path) as dataset:
        status = {
            float(c): STATUS[int(s)]
            for c, s in zip(dataset["solve.courant"], dataset["status"].squeeze(), strict=True)
        }
        message = str(dataset["message"].sel({"solve.courant": 3.0}).item())
    assert status == {0.8: "done", 3.0: "diverged"}
    assert "at step" in message


def test_a_failed_point_is_in_the_dataset_and_in_the_exit_status(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    original = measured.measure

    def fails_at_seven(run, config, modules):
        if config.n == 7:
            raise ZeroDivisionError("made for this test")
        return original(run, config, modules)

    monkeypatch.setattr(measured, "measure", fails_at_seven)
    arguments = ["-m", *SMALL, "n=5,7", "hydra/launcher=basic"]
    assert main(arguments) == 1
    shown = capsys.readouterr()
    assert "1 failed" in shown.out
    (log,) = (tmp_path / "results" / "runs").glob("*-n7-*.log")
    assert "Traceback" in (said := log.read_text())
    assert "made for this test" in said
    monkeypatch.setattr(measured, "measure", original)
    assert main(arguments) == 1, "a failed point is neither a result nor tried again by itself"
    assert "retry=failed runs them again" in capsys.readouterr().err
    assert main([*arguments, "retry=failed"]) == 0


def test_metrics_of_another_version_are_measured_again_without_running(swept, monkeypatch):
    folder, _ = swept
    monkeypatch.chdir(folder)
    changed = dict.fromkeys(("frequency_error",), 0)
    monkeypatch.setattr("sphstudy.store.identity.metrics_version", lambda config: "another")
    original = measured.measure

    def measure(run, config, modules):
        changed["frequency_error"] += 1
        return original(run, config, modules)

    monkeypatch.setattr(measured, "measure", measure)
    monkeypatch.setattr(launching.Launching, "run", None)
    dataset = sphstudy.sweep(scene="plate", h=[1.5, 1.7], n=[5, 7], **{"scene.periods": 0.3})
    assert changed["frequency_error"] == 4
    assert np.isfinite(dataset["frequency_error"]).all()
    assert metrics


def test_a_damaged_record_is_run_again(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main([*SMALL, "n=5"]) == 0
    (path,) = records(tmp_path / "results").values()
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    assert main([*SMALL, "n=5"]) == 0
    assert "unreadable" in capsys.readouterr().err
    with xr.open_dataset(path) as run:
        assert int(run["status"]) == STATUS.index("done")


def test_from_python(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    settings = {"scene": "plate", "scene.periods": 0.3, "n": 5}
    run = sphstudy.run(**settings, **{"record.times": [0.0, 0.5, 1.0]})
    labels = [str(v) for v in run["snapshot_label"].values]
    assert len(labels) == 4
    assert labels[-1] == "vibrate"
    np.testing.assert_allclose(
        run["snapshot_time"].values[:3], [0.0, 0.5, 1.0], atol=float(run["time_step"])
    )
    dataset = sphstudy.sweep(h=[1.5, 1.7], **settings)
    assert list(dataset["h"].values) == [1.5, 1.7]
    (path,) = [
        p for p in (tmp_path / "results" / "sweeps").glob("*.nc") if len(xr.load_dataset(p)["h"]) == 2
    ]
    xr.testing.assert_identical(sphstudy.open(path.stem), dataset)
    with pytest.raises(ValueError, match="there is neither"):
        sphstudy.open("nothing")
