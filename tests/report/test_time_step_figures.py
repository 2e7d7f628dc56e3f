"""Time steps: what is made of stored points, and that figures and tables show it."""

import numpy as np
import pytest

from sphstudy.analysis import results, time_steps
from sphstudy.analysis.results import Missing
from sphstudy.configuration.composition import session
from sphstudy.report import time_steps as step_tables
from sphstudy.report.figures import time_step as figures
from tests.support.figures import drawn
from tests.support.results import altered

NONE = "no stable step found down to C = 0.2"
ERROR = -0.02


@pytest.fixture(scope="module")
def empty(tmp_path_factory):
    """The study with nothing stored."""
    with session() as hydra:
        return results.load("time_step", hydra, [], str(tmp_path_factory.mktemp("empty")))


@pytest.fixture(scope="module")
def full(empty):
    """The same with made-up numbers: limits C = h (0.985 of what is predicted), none without damping by
    Heun's method; errors that change by 0.3 (Δt/limit)², and runs that diverge beyond the limit.
    """
    found = altered(empty)
    table = empty.table.assign(status="done", message="")
    searched, undamped = table["solve"] == "limit", table["block"].str.endswith("undamped")
    table["predicted_courant"] = (table["h"] / 0.985).where(searched & (table["method"] == "tl"))
    table["largest_stable_courant"] = table["h"].where(searched & ~undamped)
    table.loc[undamped, "message"] = NONE
    courant = table["solve.courant"].where(
        table["solve.time_step"] == "courant", table["solve.safety"] * table["h"] / 0.985
    )
    share = courant / table["h"]
    table["frequency_error_2d"] = (ERROR * (1.0 + 0.3 * share**2)).where(~searched)
    table.loc[~searched & (share > 1.0), "status"] = "diverged"
    found.table = table
    return found


def test_limits_are_read_with_the_integrator_that_ran(full):
    found = time_steps.limits(full.table)
    schemes = set(found[time_steps.SCHEME].itertuples(index=False, name=None))
    with_viscosity = {("tl", "heun", True), ("thesis", "heun", True)}
    assert (
        schemes
        == {("tl", "verlet", False), ("tl", "heun", False), ("thesis", "heun", False)} | with_viscosity
    )
    bare = found[(found["integrator"] == "heun") & ~found["damped"]]
    assert bare["found"].isna().all()
    assert (bare["lowest"] == 0.2).all()
    rest = found.drop(bare.index)
    np.testing.assert_array_equal(rest["found"], rest["h"])


def test_changes_are_against_the_shortest_step(full):
    found = time_steps.changes(full.table)
    assert set(found["method"]) == {"tl", "thesis"}
    for _, own in found.groupby(["method", "h"]):
        assert own["courant"].is_monotonic_increasing
        shares = own["share"].to_numpy()
        assert own["change"].iloc[0] == 0.0
        expected = 0.3 * (shares**2 - shares[0] ** 2) / (1.0 + 0.3 * shares[0] ** 2)
        np.testing.assert_allclose(own["change"], np.where(shares > 1.0, np.nan, expected), atol=1e-12)
    assert (found["status"] == "diverged").any()


def test_the_step_worth_taking_is_the_longest_that_changes_little(full):
    found = time_steps.changes(full.table)
    best = time_steps.worth(found)
    assert len(best) == 8
    for _, row in best.iterrows():
        own = found[(found["method"] == row["method"]) & (found["h"] == row["h"])]
        good = own[own["change"] < 0.1]
        assert row["courant"] == good["courant"].max() < row["h"]


def test_a_good_step_beyond_a_bad_one_is_not_worth_taking(full):
    found = time_steps.changes(full.table)
    own = found[(found["method"] == "thesis") & (found["h"] == 1.9)].copy()
    own.loc[own["courant"] == 0.6, "change"] = 0.2
    assert time_steps.worth(own)["courant"].tolist() == [0.4]


def test_an_unstable_step_that_did_no_harm_yet_is_not_worth_taking(full):
    found = time_steps.changes(full.table)
    own = found[(found["method"] == "thesis") & (found["h"] == 1.3)].assign(change=0.0)
    assert own["share"].max() > 1.0
    assert time_steps.worth(own)["courant"].tolist() == [1.2]


def test_every_limit_is_drawn_beside_its_prediction(full):
    drawing = drawn(figures.limits, full)
    assert [axes.get_title() for axes in drawing.axes] == list(figures.PANELS.values())
    for axes, (method, integrator) in zip(drawing.axes, figures.PANELS, strict=True):
        lines = [one for one in axes.get_lines() if one.get_xdata().size]
        predicted = [one for one in lines if one.get_linestyle() == "--"]
        found = [one for one in lines if one.get_linestyle() == ":"]
        none = [one for one in lines if one.get_linestyle() == "None"]
        assert len(predicted) == len(found) == 3
        for dashed, dotted in zip(predicted, found, strict=True):
            np.testing.assert_array_equal(dotted.get_ydata(), [1.3, 1.5, 1.7, 1.9])
            expected = dotted.get_ydata() / (0.985 if method == "tl" else np.nan)
            np.testing.assert_allclose(dashed.get_ydata(), expected)
        assert len(none) == (3 if integrator == "heun" else 0)
        assert all((one.get_ydata() == 0.2).all() and one.get_ydata().size == 4 for one in none)


def test_steps_are_drawn_with_the_one_worth_taking_ringed(full):
    found = time_steps.worth(time_steps.changes(full.table))
    drawing = drawn(figures.worth, full)
    assert len(drawing.axes) == 2
    for axes, method in zip(drawing.axes, ("tl", "thesis"), strict=True):
        rings = [one for one in axes.get_lines() if one.get_markersize() == 11]
        shown = [one.get_xdata()[0] for one in rings]
        np.testing.assert_allclose(shown, found.loc[found["method"] == method, "share"])
        crosses = np.concatenate([o.get_xdata() for o in axes.get_lines() if o.get_marker() == "x"])
        assert crosses.min() > 1.0


def test_an_empty_store_is_said_to_lack_data(empty):
    for definition in (figures.limits, figures.worth):
        with pytest.raises(Missing):
            drawn(definition, empty)
    assert step_tables.tables(empty) == []


def test_tables_name_limits_and_what_is_worth_taking(full):
    limits, worth = step_tables.tables(full)
    (row,) = (r for r in limits.rows if [c.text for c in r[:5]] == ["tl", "verlet", "no", "0.3", "5"])
    assert [cell.text for cell in row[5:]] == [f"{h:.3f} (0.9850)" for h in (1.3, 1.5, 1.7, 1.9)]
    (row,) = (r for r in limits.rows if [c.text for c in r[:5]] == ["tl", "heun", "no", "0.49", "5"])
    assert [cell.text for cell in row[5:]] == [NONE] * 4
    best = time_steps.worth(time_steps.changes(full.table))
    assert len(worth.rows) == len(best)
    for row, (_, expected) in zip(worth.rows, best.iterrows(), strict=True):
        assert row[4].order == expected["courant"]
        assert row[7].order == expected["error"] == pytest.approx(ERROR, rel=0.01)
