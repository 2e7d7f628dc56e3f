"""`sphstudy study speed`: wrong input answered in a line, the plan, and a run with measuring left out."""

import pytest

from sphstudy.__main__ import main
from sphstudy.benchmarks.speed import measurements as parts
from sphstudy.benchmarks.speed.settings import PARTS, chosen
from sphstudy.store.netcdf import read_dataset
from tests.benchmarks.speed.synthetic import measurements


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("quick=maybe", "quick=maybe: should be true or false"),
        ("rounds=0", "rounds=0: should be a whole number from 1 to 1000"),
        ("rounds=2.5", "rounds=2.5: should be a whole number"),
        ("parts=forms,turbo", "unknown part 'turbo'; there are forms, growth"),
        ("h=1.5", "h=1.5: unknown option of speed 'h'; there are dry-run, parts"),
        ("quick=true quick=false", "quick: is given twice"),
        ("results=", "results=: lacks its value"),
    ],
)
def test_wrong_input_is_answered_in_a_line(override, said, capsys):
    assert main(["study", "speed", *override.split()]) == 2
    complaint = capsys.readouterr().err
    assert said in complaint
    assert complaint.count("\n") == 1


def test_settings():
    usual, quick = chosen({}), chosen({"quick": "true"})
    assert usual.parts == tuple(PARTS)
    assert quick.rounds < usual.rounds
    assert quick.slice_seconds < usual.slice_seconds
    assert chosen({"quick": "true", "rounds": "9"}).rounds == 9
    # Always in the order in which they are measured.
    assert chosen({"parts": "[runs,forms]"}).parts == ("forms", "runs")


def test_measures_writes_and_tells_what_it_took(tmp_path, monkeypatch, capsys):
    def made_up(hydra, settings, found):
        made = measurements()
        found.rates, found.scalings, found.runs = made.rates[:8], made.scalings, made.runs

    monkeypatch.setitem(parts._MEASURE, "forms", made_up)
    command = ["study", "speed", "parts=forms", f"results={tmp_path}"]
    assert main([*command, "--dry-run"]) == 0
    assert "last time" not in capsys.readouterr().out
    assert not (tmp_path / "speed").exists()
    assert main(command) == 0
    assert "speed.nc" in capsys.readouterr().out
    stored = read_dataset(str(tmp_path / "speed" / "speed.nc"), tmp_path)
    assert stored.sizes["rate"] == 8
    assert stored.attrs["rounds"] == 5
    assert main([*command, "--dry-run"]) == 0
    assert "the last time" in capsys.readouterr().out
