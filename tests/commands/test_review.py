"""Studies from end to end: run, reference, compare, measure, report, on cells of a second."""

import shutil

import numpy as np
import pytest
import xarray as xr

import sphstudy
from sphstudy import catalogue
from sphstudy.__main__ import main
from sphstudy.store import provenance
from sphstudy.store.netcdf import write
from sphstudy.store.store import read

PLATE = "{scene: plate, h: [1.5, 1.7], n: [5, 7], scene.periods: 0.3}"
CHOICES = """
title: choices
blocks:
  plate:
    scene: plate
    n: 5
    scene.periods: 0.3
    vary: {scene.rho: 7750.0000001, scene.columns: spacing, scene.plane: stress}
"""
COMMIT = "0123456789" * 4


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with studies `tiny` and `choices`, both run, in which sources count as committed."""
    folder = tmp_path_factory.mktemp("place")
    (folder / "studies").mkdir()
    (folder / "reference").mkdir()
    shutil.copy(catalogue.folder("reference") / "thesis_values.yaml", folder / "reference")
    text = f"title: tiny\nblocks: {{grid: {PLATE}}}\nfigures: [plate.frequency_error]\nclaims: [V1]\n"
    (folder / "studies" / "tiny.yaml").write_text(text)
    (folder / "studies" / "choices.yaml").write_text(CHOICES)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setitem(catalogue.FOLDERS, "studies", folder / "studies")
        patch.setitem(catalogue.FOLDERS, "reference", folder / "reference")
        real = provenance.provenance()
        patch.setattr(provenance, "provenance", lambda: {**real, "git_state": COMMIT})
        patch.setattr("sphstudy.running.one_run.provenance", provenance.provenance)
        for name in ("tiny", "choices"):
            assert main(["study", name, "hydra/launcher=basic"]) == 0
        yield folder


@pytest.fixture
def referenced(place):
    assert main(["reference", "tiny"]) == 0
    return place / "reference" / "tiny.nc"


def test_a_study_leaves_dataset_and_report(place):
    assert sorted(p.name for p in (place / "results" / "sweeps").iterdir()) == ["choices.nc", "tiny.nc"]
    page = (place / "results" / "reports" / "tiny" / "index.html").read_text()
    assert "V1" in page
    assert "data:image" in page


def test_dry_run_tells_what_would_run_why_and_runs_nothing(place, capsys):
    assert main(["study", "tiny", "n=5,9", "--dry-run"]) == 0
    shown = capsys.readouterr().out
    assert "2 runs to do" in shown
    assert shown.count(" new ") == 2
    assert shown.count("stored: done") == 2
    assert not list((place / "results" / "runs").glob("*n9*"))


def test_a_reference_holds_values_intervals_reasons_and_provenance(referenced):
    with xr.open_dataset(referenced) as stored:
        assert stored.attrs["git_state"] == COMMIT
        assert stored.attrs["library_versions"]
        allowed = stored["frequency_error"].attrs
        assert allowed["half_width"] > 0.0
        assert "half of the smallest effect" in allowed["half_width_reason"]
        found = sphstudy.open("tiny")["frequency_error"]
        np.testing.assert_array_equal(stored["frequency_error"], found)
        assert "cpu_seconds" not in stored


def test_comparing_with_it_is_within_and_shows_the_interval(referenced, capsys):
    assert main(["compare", "tiny", "all=true"]) == 0
    shown = capsys.readouterr().out
    assert "outside" not in shown
    assert "frequency_error " in shown
    assert " … " in shown


def test_another_method_falls_outside_worst_first(referenced, capsys):
    changed = ["tiny", "scene.columns=spacing"]
    assert main(["study", *changed, "hydra/launcher=basic"]) == 1
    rows = [line for line in capsys.readouterr().out.splitlines() if " … " in line]
    verdicts = ["outside" if "outside" in row else "within" for row in rows]
    assert "outside" in verdicts
    assert verdicts == sorted(verdicts)


def test_a_value_that_is_moved_out_of_its_interval_is_found(referenced, capsys):
    with xr.open_dataset(referenced) as stored:
        moved = stored.load()
    half = moved["frequency_error"].attrs["half_width"]
    for shift, status in ((0.9 * half, 0), (1.1 * half, 1)):
        changed = moved.copy(deep=True)
        changed["frequency_error"] += shift
        changed["frequency_error"].attrs = moved["frequency_error"].attrs
        changed.to_netcdf(referenced)
        assert main(["compare", "tiny"]) == status
    assert "frequency_error" in capsys.readouterr().out


def test_an_unstable_cell_is_shown_but_not_judged(referenced, place, capsys):
    path = place / "studies" / "tiny.yaml"
    text = path.read_text()
    with xr.open_dataset(referenced) as stored:
        moved = stored.load()
    moved["frequency_error"][:] += 1.0
    moved.to_netcdf(referenced)
    try:
        path.write_text(text + "unstable: [{where: {scene: plate, n: [5, 7]}, reason: made so}]\n")
        assert main(["compare", "tiny", "all=true"]) == 0
    finally:
        path.write_text(text)
    shown = capsys.readouterr().out
    assert "made so" in shown
    assert "within" not in shown


def test_two_datasets_are_compared_cell_by_cell(place, tmp_path, capsys):
    before = sphstudy.open("tiny")
    after = before.copy(deep=True)
    after["frequency_error"][0, 0] *= 1.0 + 2e-6
    path = tmp_path / "after.nc"
    after.to_netcdf(path)
    assert main(["compare", str(path), "tiny", "tolerance=1e-5"]) == 0
    assert main(["compare", str(path), "tiny", "tolerance=1e-6"]) == 1
    (row,) = [r for r in capsys.readouterr().out.splitlines() if " outside " in r]
    assert row.split()[0] == "frequency_error"


def test_what_is_not_there_is_missing_and_not_passed_over(referenced, place, tmp_path, capsys):
    assert main(["compare", "tiny", f"results={tmp_path}"]) == 1
    assert "missing" in capsys.readouterr().out
    half = sphstudy.open("tiny").isel(n=[0])
    half.to_netcdf(tmp_path / "half.nc")
    assert main(["compare", str(tmp_path / "half.nc"), "tiny"]) == 1
    assert main(["compare", "tiny", str(tmp_path / "half.nc")]) == 0


def test_a_study_file_that_names_what_is_not_there_is_refused_before_anything_runs(place, capsys):
    for text, complaint in (
        ("claims: [X9]", "unknown claim 'X9'; there are"),
        ("figures: [plate.gone]", "unknown figure 'plate.gone'; "),
        ("shows: [gone]", "unknown study 'gone'; there are"),
    ):
        path = place / "studies" / "wrong.yaml"
        path.write_text(f"title: wrong\nblocks: {{grid: {PLATE}}}\n{text}\n")
        assert main(["study", "wrong", "n=99"]) == 2
        assert complaint in capsys.readouterr().err
        path.unlink()


def test_measuring_again_gives_the_same_numbers_from_the_fields(place, capsys):
    before = sphstudy.open("tiny")
    assert main(["measure", "tiny"]) == 0
    assert "4 of 4 points measured again" in capsys.readouterr().out
    xr.testing.assert_allclose(sphstudy.open("tiny"), before, rtol=1e-14)


def test_a_half_finished_study_still_gives_a_report_that_says_so(place, capsys):
    (place / "reference" / "tiny.nc").unlink(missing_ok=True)
    assert main(["report", "tiny", "n=5,9"]) == 0
    page = (place / "results" / "reports" / "tiny-n=5_9" / "index.html").read_text()
    assert "missing" in page
    assert "no data" in capsys.readouterr().out


@pytest.mark.parametrize("state", [f"{COMMIT} (dirty)", "not a git checkout", "unknown"])
def test_references_are_refused_from_sources_that_are_not_committed(place, state, monkeypatch, capsys):
    monkeypatch.setattr(provenance, "provenance", lambda: {"git_state": state})
    assert main(["reference", "tiny"]) == 2
    assert "commit them first" in capsys.readouterr().err


def test_references_are_refused_for_runs_of_dirty_sources_and_for_missing_runs(place, capsys):
    path = place / "results" / "runs" / str(sphstudy.open("tiny")["record"].sel(h=1.7, n=7).item())
    whole = path.read_bytes()
    try:
        run = read(path)
        run.attrs["git_state"] += " (dirty)"
        write(run, path)
        assert main(["reference", "tiny"]) == 2
        assert "(dirty)" in capsys.readouterr().err
        path.unlink()
        assert main(["reference", "tiny"]) == 2
        assert "is missing" in capsys.readouterr().err
    finally:
        path.write_bytes(whole)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["compare"], "write sphstudy compare STUDY"),
        (["compare", "tiny", "foo=1"], "foo=1: unknown option of compare 'foo'; there are all"),
        (["compare", "tiny", "gone.nc"], "gone.nc: there is neither"),
        (["compare", "gone"], "unknown study 'gone'; there are"),
        (["compare", "one.nc"], "write sphstudy compare STUDY"),
        (["compare", "tiny", "all=maybe"], "all=maybe: should be true or false"),
        (["compare", "tiny", "tiny", "tolerance=-1"], "tolerance=-1: should be a number"),
        (["compare", "studies/tiny.yaml", "tiny"], "cannot be read"),
        (["compare", "choices"], "there is nothing to compare"),
        (["study", "tiny", "n=5", "n=7"], "n: is given twice"),
        (["measure", "tiny", "-f"], "-f: goes with run, study, not with measure"),
        (["measure", "tiny", "results=/proc/x"], "cannot be written"),
        (["compare", "tiny", "choices", "tolerance=x"], "tolerance=x: should be a number"),
        (["report"], "report: name one of"),
        (["measure", "gone"], "unknown study 'gone'; there are"),
        (["reference", "tiny", "n=5"], "n=5: unknown option of reference 'n'; there are results"),
        (["h=1.5", "--dry-run"], "--dry-run: goes with study, speed, peers, not with run"),
    ],
)
def test_wrong_commands_are_answered_in_a_line(place, arguments, complaint, capsys):
    assert main(arguments) == 2
    assert complaint in capsys.readouterr().err
