"""The command that extrapolates over resolutions, on a dataset made up without running anything."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.__main__ import main
from sphstudy.store.netcdf import write
from sphstudy.store.record import STATUS
from sphstudy.text import with_uncertainty
from tests.analysis.test_extrapolation import swept


@pytest.fixture
def file(tmp_path, monkeypatch):
    """The made-up dataset in `results/sweeps`; beside it one without spacings and one of a single n."""
    monkeypatch.chdir(tmp_path)
    dataset = swept(tmp_path / "results")
    dataset["status"].loc[{"h": 1.5, "n": 7}] = STATUS.index("diverged")
    dataset["tip"].loc[{"h": 1.5, "n": 7}] = np.nan
    write(dataset.drop_vars("spacing"), tmp_path / "old.nc")
    write(dataset.isel(n=[1]), tmp_path / "single.nc")
    (tmp_path / "text.nc").write_text("no dataset")
    path = tmp_path / "results" / "sweeps" / "swept.nc"
    write(dataset, path)
    return path


def rows(shown):
    """What a table shows, line by line, by first column."""
    return {words[0]: words[1:] for line in shown.splitlines() if len(words := line.split()) > 4}


def test_a_line_for_all_that_differ_in_n_only(file, capsys):
    assert main(["extrapolate", "swept", "tip"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("tip: the tip (m)\n")
    table = rows(shown)
    assert table["h"] == ["n=5", "n=7", "n=11", "extrapolated", "order", "remark"]
    values = [f"{1.3 + (0.4 / n) ** 1.3:.6g}" for n in (5, 7, 11)]
    assert table["1.3"] == [*values, "1.300", "±", "0.017", "1.3"]
    assert table["1.5"][1] == "–"
    assert (
        " ".join(table["1.5"][3:]) == "– – too few resolutions: 2, 3 are needed; left out: n=7 diverged"
    )
    assert "p observed" in shown


def test_a_given_order_and_several_metrics_go_into_a_file(file, tmp_path, capsys):
    path = tmp_path / "new" / "zero.nc"
    assert (
        main(["extrapolate", str(file), "tip", "droop", "tip", "--order=1", "--output", str(path)]) == 0
    )
    shown = capsys.readouterr().out
    assert shown.count("tip: ") == 1
    assert shown.endswith(f"dataset: {path}\n")
    assert rows(shown)["1.3"][3:] == ["2", "±", "0", "1"]
    with xr.open_dataset(path) as stored:
        assert dict(stored.sizes) == {"h": 2}
        np.testing.assert_allclose(stored["droop"], 2.0, rtol=1e-14)
        assert stored["droop_order"].values.tolist() == [1.0, 1.0]
        assert "left out: n=7 diverged" in str(stored["tip_flag"].sel(h=1.5).item())
    assert [p.name for p in path.parent.iterdir()] == ["zero.nc"]


def test_a_metric_that_no_point_has_is_said_to_be_without_values(file, capsys):
    with xr.open_dataset(file) as dataset:
        dataset = dataset.load()
    dataset["tip"][:] = np.nan
    write(dataset, file)
    assert main(["extrapolate", "swept", "tip"]) == 0
    assert "no point has it" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (1.23456, 0.0123, "1.235 ± 0.012"),
        (1.23456, 0.0996, "1.23 ± 0.10"),
        (-0.00012346, 0.0000021, "-1.235e-04 ± 2.1e-06"),
        (1.23456e-9, 2.2e-11, "1.235e-09 ± 2.2e-11"),
        (1.2e-12, 2.2e-11, "1.2e-12 ± 2.2e-11"),
        (12345.6, 123.0, "12350 ± 120"),
        (0.5, 0.0, "0.5 ± 0"),
        (np.nan, np.nan, "–"),
    ],
)
def test_a_value_has_the_digits_that_its_uncertainty_leaves(value, uncertainty, text):
    assert with_uncertainty(value, uncertainty) == text


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ([], "extrapolate: write sphstudy extrapolate STUDY|FILE.nc METRIC"),
        (["swept"], "extrapolate: write sphstudy extrapolate STUDY|FILE.nc METRIC"),
        (["gone", "tip"], "gone: studies are bending"),
        (["gone.nc", "tip"], "gone.nc: there is neither gone.nc nor results/sweeps/gone.nc.nc"),
        (["plate", "tip"], "plate: run study plate first"),
        (["swept", "tip", "results=elsewhere"], "nor elsewhere/sweeps/swept.nc"),
        (["text.nc", "tip"], "text.nc: cannot be read"),
        (["swept", "tips"], "swept: tips: there is no such metric; did you mean tip?"),
        (["swept", "tip", "cpu_seconds"], "there is no such metric; there are tip, droop"),
        (["old.nc", "tip"], "old.nc: spacing: the dataset lacks the particle spacings"),
        (["single.nc", "tip"], "n: the dataset has 1 value of n, an extrapolation takes two or more"),
        (["swept", "tip", "--order", "one"], "--order=one: should be a number from 0.01 to 50"),
        (["swept", "tip", "--order", "-1"], "--order=-1: should be a number"),
        (["swept", "tip", "--order=0"], "--order=0: should be a number"),
        (["swept", "tip", "--order=nan"], "--order=nan: should be a number"),
        (["swept", "tip", "--order"], "--order: lacks its value (see sphstudy extrapolate --help)"),
        (
            ["swept", "tip", "--over", "h"],
            "unknown option of extrapolate '--over'; did you mean '--order'?",
        ),
        (["swept", "tip", "--output", "results/sweeps/swept.nc"], "that is the dataset itself"),
        (["swept", "tip", "--output", "text.nc/zero.nc"], "--output=text.nc/zero.nc: cannot be written"),
    ],
)
def test_wrong_input_is_answered_in_a_line_or_two(file, arguments, complaint, capsys):
    assert main(["extrapolate", *arguments]) == 2
    told = capsys.readouterr().err
    assert complaint in told
    assert len(told.splitlines()) <= 2
