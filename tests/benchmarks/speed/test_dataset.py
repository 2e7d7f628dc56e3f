"""The dataset, its tables and its figures, from measurements made up."""

import dataclasses

import numpy as np
import pytest

from sphstudy.benchmarks.speed import cases
from sphstudy.benchmarks.speed import figures as speed
from sphstudy.benchmarks.speed.bounds import bounds
from sphstudy.benchmarks.speed.dataset import dataset
from sphstudy.benchmarks.speed.measurements import Measurements
from sphstudy.benchmarks.speed.settings import Settings
from sphstudy.benchmarks.speed.tables import print_tables
from sphstudy.benchmarks.speed.terms import term_costs
from sphstudy.store.netcdf import read_dataset, write
from tests.benchmarks.speed.synthetic import measurements, rate


@pytest.fixture(scope="module")
def found():
    return dataset(measurements(), Settings())


def test_every_variable_says_what_it_is_and_survives_a_file(found, tmp_path):
    for name, variable in found.variables.items():
        assert variable.attrs["long_name"], name
        assert variable.attrs["units"], name
    for attribute in ("processor", "processor_kind", "git_state", "library_versions", "date_created"):
        assert found.attrs[attribute]
    write(found, tmp_path / "speed.nc")
    again = read_dataset(str(tmp_path / "speed.nc"), tmp_path)
    np.testing.assert_array_equal(again["pair_time"], found["pair_time"])
    assert list(again["rate"].values) == list(found["rate"].values)


def test_times_per_pair_count_pairs_and_evaluations_as_they_say(found):
    plate = found.isel(rate=0)
    assert plate["rate_method"] == "thesis"
    assert float(plate["pair_time"]) == pytest.approx(10.0)
    assert float(plate["directed_pair_time"]) == pytest.approx(5.0)
    assert float(plate["interacting_pair_time"]) == pytest.approx(12.5)
    # 2 evaluations of 10 000 pairs at 10 ns.
    assert float(plate["step_time"]) == pytest.approx(2e-4)
    assert float(plate["particle_steps"]) == pytest.approx(1000 / 2e-4)
    # Rounds of 1, 1.5 and 0.9 medians.
    assert float(plate["step_time_spread"]) == pytest.approx(1.25 - 0.95)
    np.testing.assert_allclose(plate["step_times"], np.array([1.0, 1.5, 0.9]) * 2e-4)


def test_bounds_stand_beside_what_they_bound(found):
    rows = {str(b): found.isel(bound=k) for k, b in enumerate(found["bound"].values)}
    assert float(rows["thesis, plate"]["bound_ratio"]) == pytest.approx(10.0 / 8.0)
    assert float(rows["tl, perturbed"]["bound_measured"]) == pytest.approx(6.5 / 5.0)
    sweep = rows["4 runs"]
    assert float(sweep["bound_measured"]) == pytest.approx(np.median([1.6, 2.0]))
    assert str(sweep["bound_remark"].item()) == "control 1.8"
    assert float(rows["tl, modes of the plate"]["bound_measured"]) == pytest.approx(0.2)


def test_every_bound_that_a_case_names_is_there():
    every = [*cases.forms(), *(case for form in cases.growth() for case in form), *cases.terms(20)]
    assert {case.bound for case in every} - {""} <= set(bounds())
    assert len({case.label for case in cases.terms(20)}) == len(cases.terms(20))


def test_what_a_term_costs_is_read_from_steps_not_from_pairs():
    some = measurements()
    # The crack hides a tenth of the pairs: without it there are more, at 15 ns each.
    rates = [
        dataclasses.replace(r, pairs=11_000, seconds=1.1 * r.seconds) if r.case.term == "crack" else r
        for r in some.rates
    ]
    costs = {
        (one.method, one.term): one for one in term_costs(dataset(Measurements(rates=rates), Settings()))
    }
    xsph, crack = costs["thesis", "XSPH"], costs["thesis", "crack"]
    assert (xsph.full.median, xsph.never.median) == pytest.approx((20.0, 15.0))
    assert (xsph.cost, xsph.left) == pytest.approx((5.0, 1.0))
    assert (xsph.off.lower, xsph.off.upper) == pytest.approx((15.0 * 0.95, 15.0 * 1.25))
    assert crack.cost == pytest.approx(20.0 - 16.5)
    assert ("tl", "hourglass") in costs


def test_a_system_that_went_bad_has_no_time():
    bad = rate(cases.forms()[0], 10.0, wrong="a step too far")
    found = dataset(Measurements(rates=[bad]), Settings())
    assert np.isnan(found["pair_time"].item())
    assert np.isnan(found["bound_ratio"].item())
    assert found["rate_wrong"].item() == "a step too far"


def test_tables_show_numbers_and_bounds(found, capsys):
    print_tables(found)
    said = capsys.readouterr().out
    for text in (
        "thesis, plate, shuffled",
        "bound ratio",
        "1.25",
        "control 1.8",
        " 300 ",
        "off / never",
    ):
        assert text in said


def test_figures_draw_every_form_and_every_term(found, tmp_path):
    growth = speed.growth(found).axes[0]
    labels = growth.get_legend_handles_labels()[1]
    assert len(labels) == 6
    heights = [container.lines[0].get_ydata() for container in growth.containers]
    np.testing.assert_allclose(heights[0], [5.0, 5.5, 6.0, 6.5])
    terms = speed.terms(found)
    named = [[tick.get_text() for tick in axes.get_yticklabels()] for axes in terms.axes]
    assert named == [list(cases.THESIS_TERMS), list(cases.TL_TERMS)]
    assert [path.name for path in speed.write_figures(found, tmp_path)] == ["growth.png", "terms.png"]


def test_what_was_not_measured_is_not_there():
    empty = dataset(Measurements(remarks=["threads: not measured"]), Settings())
    assert "rate" not in empty.dims
    assert empty.attrs["remarks"] == "threads: not measured"
    print_tables(empty)
