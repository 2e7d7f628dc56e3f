"""The report of a study says what is stored, what is missing and what went wrong, in one file."""

import math
import re

import pytest

from sphstudy import text
from sphstudy.analysis import compare
from sphstudy.analysis.compare import OUTSIDE, WITHIN, Comparison
from sphstudy.analysis.results import Missing
from sphstudy.configuration.composition import session
from sphstudy.report import page, tables
from tests.report import sample

GRID = "Points of block grid, scene plate"
CHANGES = "Change by each option in block options"


@pytest.fixture(scope="module")
def hydra():
    with session() as composing:
        yield composing


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("sample")


@pytest.fixture(scope="module")
def found(folder, hydra):
    with pytest.MonkeyPatch.context() as patch:
        yield sample.load(folder, patch, hydra)


@pytest.fixture(scope="module")
def written(found, folder):
    figures = folder / "report" / "figures"
    figures.mkdir(parents=True)
    (figures / "made_up.lacking.png").write_text("of an earlier report")
    return sample.write_page(found, folder / "report")


@pytest.fixture(scope="module")
def read(written):
    return sample.Reader(written)


def shown(read):
    return " ".join(read.text.split())


def test_the_first_lines_count_points_by_outcome(read):
    assert "9 points" not in shown(read)
    # The first point of `options` is one of `grid`: the same record.
    assert "8 points: 4 done, 1 diverged, 1 failed, 2 missing; 26.2 s of CPU time in all" in shown(read)


def test_origin_is_told_and_dirty_sources_are_called_so(read):
    for part in ("9.8.7", "Abacus", "numpy 2.0", "2026-01-02 03:04 UTC"):
        assert part in shown(read)
    assert "commit 0123456789 dirty (with uncommitted changes)" in shown(read)


def test_every_number_of_the_points_is_that_of_the_table(read, found):
    headings, rows = read.tables[GRID]
    assert headings == ["h", "n", "status", "frequency error (%)", "CPU (s)", "particles"]
    points = found.select(block="grid")
    assert len(rows) == len(points) == 6
    for row, (_, point) in zip(rows, points.iterrows(), strict=True):
        assert row[2][0] == point["status"]
        for name, (said, order) in zip(("h", "n"), row[:2], strict=True):
            assert said == f"{point[name]:g}"
            assert float(order) == point[name]
        for name, (said, order) in zip(
            ("frequency_error", "cpu_seconds", "particles"), row[3:], strict=True
        ):
            assert said == text.metric(name, point[name], found.attributes[name]["units"])
            assert float(order) == point[name] or math.isnan(float(order)) == math.isnan(point[name])
    assert {row[3][0] for row in rows} == {"−3.04", "−12.0", "1.25×10⁻⁵", "–"}


def test_of_very_many_points_the_first_are_listed(found, monkeypatch):
    monkeypatch.setattr(tables, "LONGEST", 4)
    group = next(group for group in tables.groups(found, found.table) if group.block == "grid")
    whole = tables.points(group)
    assert len(whole.rows) == 4
    assert whole.caption == f"{GRID}: the first 4 of 6, which are all in the study's dataset"


def test_of_many_points_that_are_not_done_the_first_are_named(found, tmp_path, monkeypatch):
    """In the sample there are four."""
    monkeypatch.setattr(tables, "LONGEST", 3)
    cut = shown(sample.Reader(sample.write_page(found, tmp_path / "report")))
    assert "missing grid: plate h=1.5 n=21" in cut
    assert "missing options: plate h=1.5 n=9" not in cut
    assert "and 1 more, which are all in the study's dataset" in cut


def test_several_points_in_a_place_are_no_grid(found):
    with pytest.raises(Missing, match="several points with the same h and n"):
        found.grid("frequency_error", block="options")


def test_points_that_are_not_done_stand_there_with_what_went_wrong(read):
    assert "diverged grid: plate h=1.3 n=15: speed 3e9 at step 17" in shown(read)
    assert f"failed grid: plate h=1.3 n=21: {sample.MESSAGE}" in shown(read)
    assert "missing grid: plate h=1.5 n=21" in shown(read)
    assert "missing options: plate h=1.5 n=9, scene.rho=7750.0000001" in shown(read)
    assert "more, which are all" not in shown(read)


def test_effects_are_differences_from_the_block_without_change(read):
    headings, rows = read.tables[CHANGES]
    assert headings == ["changed setting", "frequency error (%)"]
    assert [row[0][0] for row in rows] == ["none (value)", "method.artificial_stress=0.3"]
    assert [row[1][0] for row in rows] == ["−12.0", "−2.01"]
    assert float(rows[1][1][1]) == pytest.approx(sample.ARTIFICIAL - sample.OUTCOMES[1.5, 9][2])


def test_error_stands_beside_cost(read):
    headings, rows = read.tables["Error against cost in block grid"]
    assert headings[:5] == ["n", "points", "particles", "CPU a point (s)", "CPU in all (s)"]
    assert [text for text, _ in rows[0]] == ["9", "2", "972", "2.88", "5.75", "3.04 to 12.0"]


def test_settings_that_all_points_share_are_listed_with_their_meaning(read, found):
    assert "Settings that all points of grid share" in shown(read)
    assert f"scene.E {found.table['scene.E'].iloc[0]:.12g} Young's modulus [Pa]" in shown(read)


def test_claims_come_with_verdict_numbers_and_cause(read):
    assert "1 claim: 1 not reproduced" in shown(read)
    assert re.search(r"T1 All is well\..*page 1 not reproduced 1 of 2 a bug", shown(read))


def test_text_from_outside_is_text(written, read):
    assert written.count("<script>") == read.tags.count("script") == 1
    assert "<b>" not in written
    assert "A sample of <everything> that may happen" in shown(read)
    assert sample.MESSAGE in shown(read)


def test_the_page_needs_no_other_file(written, read):
    assert "http:" not in written
    assert "https:" not in written
    assert "url(" not in written
    assert "@import" not in written
    assert all(source.startswith("data:") for source in read.sources)
    assert all(link.startswith(("#", "data:")) for link in read.links)


def test_every_link_of_the_contents_leads_somewhere(read):
    assert len(read.ids) == len(set(read.ids))
    inside = {link[1:] for link in read.links if link.startswith("#")}
    assert (
        {"claims", "sample", "sample-figures", "sample-points", "provenance"} <= inside <= set(read.ids)
    )


def test_a_figure_is_inside_the_page_and_beside_it(read, folder):
    assert [image["alt"] for image in read.images] == ["Figure 9.1: A good figure."]
    figures = folder / "report" / "figures"
    assert (figures / "made_up.good.png").read_bytes().startswith(b"\x89PNG")
    assert (figures / "made_up.good.pdf").read_bytes().startswith(b"%PDF")


def test_a_figure_that_cannot_be_drawn_says_why_and_leaves_no_old_one(read, folder):
    assert "because data are missing: no point with n=99 Figure 9.1. A lacking figure." in shown(read)
    assert "because of an error: ZeroDivisionError: <b>by nothing</b>" in shown(read)
    assert "because of an error: ValueError" in shown(read)
    assert "unknown figure 'made_up.unheard_of'; " in shown(read)
    assert not (folder / "report" / "figures" / "made_up.lacking.png").exists()


def test_what_went_wrong_in_drawing_is_said_with_its_line(found, tmp_path, capfd):
    sample.write_page(found, tmp_path)
    said = capfd.readouterr().err
    assert re.search(r"figure made_up.broken: ZeroDivisionError: .* \(sample.py:\d+\)", said)
    assert "figure made_up.lacking:" not in said


def test_comparisons_are_counted_and_the_worst_shown_first(found, tmp_path, monkeypatch):
    rows = [
        Comparison(
            "sample", "frequency_error", f"h={k}", 0.1, 0.0, 0.08, "1",
            OUTSIDE if k < 3 else WITHIN, 9.0 - k, "because",
        )
        for k in range(page.WORST + 2)
    ]  # fmt: skip
    monkeypatch.setattr(compare, "against_reference", lambda results: rows)
    read = sample.Reader(sample.write_page(found, tmp_path))
    title = "Comparison with stored references"
    assert f"{title}: {page.WORST - 1} within, 3 outside" in shown(read)
    _, worst = read.tables[f"{title}: worst first"]
    _, everything = read.tables[f"{title}: all"]
    assert [row[1][0] for row in worst] == [f"h={k}" for k in range(page.WORST)]
    assert len(everything) == len(rows)
    assert [text for text, _ in worst[0][3:]] == ["10", "0 to 8", OUTSIDE, "9", "because"]


def test_a_study_without_a_single_record_says_so(folder, hydra, tmp_path):
    with pytest.MonkeyPatch.context() as patch:
        found = sample.load(tmp_path, patch, hydra, stored=False)
        read = sample.Reader(sample.write_page(found, tmp_path / "report"))
    assert "8 points: 8 missing" in shown(read)
    assert "No point has been computed yet" in shown(read)
    assert "sphstudy study sample computes it" in shown(read)


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (0.0, "0"),
        (-8467.0, "−8\u202f467"),
        (1.23456e-5, "1.235×10⁻⁵"),
        (0.0999999, "0.1000"),
        (123456.7, "123\u202f457"),
        (9876543.21, "9.877×10⁶"),
        (math.nan, "–"),
        (-math.inf, "−∞"),
    ],
)
def test_numbers_are_written_for_people(value, said):
    assert text.number(value) == said


def test_units_follow_the_number_that_is_shown():
    assert text.heading("G1_error", "1") == "G1 error (%)"
    assert text.heading("u_x_rms", "m") == "u x rms (m)"
    assert text.heading("density", "kg m-3") == "density (kg m⁻³)"
    assert text.metric("G1_error", 0.0123, "1", sign=True) == "+1.23"
    assert text.metric("end_angle_error", 0.0123, "degree") == "0.01230"


@pytest.mark.parametrize(
    ("seconds", "said"), [(26.25, "26.2 s"), (1500.0, "25 min"), (7200.0, "2 h"), (119.0, "119 s")]
)
def test_time_spans_come_in_the_unit_that_suits_them(seconds, said):
    assert text.duration(seconds) == said
