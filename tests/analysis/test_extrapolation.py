"""Extrapolation over resolutions: exact where the law holds, within the stated uncertainty elsewhere."""

import math

import numpy as np
import pytest
from scipy.optimize import curve_fit

from sphstudy.analysis import richardson
from sphstudy.analysis.dataset import combine
from sphstudy.analysis.extrapolation import extrapolated, series
from sphstudy.analysis.richardson import Extrapolation, extrapolate
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.store.netcdf import read_dataset, write
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store

THREE = np.array([0.031, 0.022, 0.017])
FIVE = np.array([0.031, 0.022, 0.02, 0.013, 0.011])
THESIS = 1.0 / np.array([40.0, 50.0, 60.0])


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0, 4.0])
@pytest.mark.parametrize("spacings", [THREE, FIVE, THESIS])
def test_a_power_law_is_recovered_exactly(spacings, order):
    values = -1.7 + 0.3 * (spacings / 0.02) ** order
    for given in (order, None):
        found = extrapolate(spacings, values, given)
        assert found.value == pytest.approx(-1.7, abs=1e-10)
        assert found.order == pytest.approx(order, abs=1e-10)
        assert found.flag == ""
    assert extrapolate(spacings[-2:], values[-2:], order).value == pytest.approx(-1.7, abs=1e-10)


def test_the_sequence_is_of_no_importance_and_neither_are_units():
    values = 2.0 + THREE**1.5 + 0.3 * THREE**2
    found = extrapolate(THREE, values)
    assert extrapolate(THREE[[1, 2, 0]], values[[1, 2, 0]]) == found
    scaled = extrapolate(1e3 * THREE, -1e6 * values)
    assert scaled.value == pytest.approx(-1e6 * found.value, rel=1e-11)
    assert scaled.uncertainty == pytest.approx(1e6 * found.uncertainty, rel=1e-9)
    assert (found.spacings, found.values) == (tuple(THREE), tuple(values))


@pytest.mark.parametrize("spacings", [THREE, FIVE, THESIS, np.array([0.08, 0.04, 0.02])])
@pytest.mark.parametrize("next_term", [-8.0, -0.5, 0.5, 8.0])
def test_a_next_term_of_the_error_stays_inside_the_uncertainty(spacings, next_term):
    values = 5.0 + 2.0 * spacings + next_term * spacings**2
    given, observed = extrapolate(spacings, values, 1.0), extrapolate(spacings, values)
    assert 0.0 < abs(observed.value - 5.0) <= observed.uncertainty
    # The error of the linear extrapolation is known.
    error = abs(next_term) * spacings[-1] * spacings[-2]
    assert abs(given.value - 5.0) == pytest.approx(error, rel=1e-6)
    assert 2.0 * error * (1.0 - 1e-6) < given.uncertainty < 7.0 * error


def test_uncertainties_are_what_their_rules_say():
    halved, values = np.array([0.4, 0.2, 0.1]), np.array([3.0, 2.0, 1.6])
    # Linear through the two finest: 1.2; through the next coarser pair: 1.0.
    given = extrapolate(halved, values, 1.0)
    assert (given.value, given.uncertainty) == (pytest.approx(1.2), pytest.approx(2.0 * 0.2))
    slow, fast = (extrapolate(halved, 1.0 + halved**p) for p in (1.5, 4.0))
    assert slow.uncertainty == pytest.approx(1.25 * 0.1**1.5)
    # A third of the last difference, as with order 2, though the order is 4.
    assert fast.uncertainty == pytest.approx(1.25 * (0.2**4 - 0.1**4) / 3.0)


def coverage(rng, spacings, noise, observe):
    """Shares of random series that give a value, and of these, of those with v0 inside the uncertainty.

    The errors fall with an order from 0.5 to 2, have a next term, and noise relative to their range.
    """
    inside = []
    for _ in range(600):
        order = rng.uniform(0.5, 2.0)
        errors = (spacings / spacings[0]) ** order
        errors *= 1.0 + rng.uniform(-0.3, 0.3) * spacings / spacings[0]
        errors += noise * np.ptp(errors) * rng.standard_normal(spacings.size)
        found = extrapolate(spacings, 1.0 + errors, None if observe else order)
        hit = abs(found.value - 1.0) <= found.uncertainty
        inside.append(math.nan if math.isnan(found.value) else hit)
    return np.isfinite(inside).mean(), np.nanmean(inside)


@pytest.mark.parametrize(
    ("spacings", "noise", "observe", "with_a_value", "covered"),
    [
        (THESIS, 0.01, False, 1.0, 0.75),
        (THESIS, 0.05, False, 1.0, 0.84),
        (FIVE, 0.05, False, 1.0, 0.86),
        (THESIS, 0.01, True, 0.9, 0.98),
        (THESIS, 0.05, True, 0.7, 0.74),
        (FIVE, 0.01, True, 0.9, 0.99),
        (FIVE, 0.05, True, 0.7, 0.94),
    ],
)
def test_most_disturbed_series_stay_inside_their_uncertainty(
    rng, spacings, noise, observe, with_a_value, covered
):
    share, inside = coverage(rng, spacings, noise, observe)
    assert share >= with_a_value
    assert inside >= covered


def test_more_than_three_are_a_fit_by_least_squares_with_its_standard_error():
    values = 3.0 + (FIVE / 0.02) ** 1.5 + 1e-2 * np.array([1.0, -1.0, 1.0, -1.0, 1.0])
    found = extrapolate(FIVE, values)
    fitted, covariance = curve_fit(
        lambda s, v0, c, order: v0 + c * (s / 0.02) ** order, FIVE, values, (3.0, 1.0, 1.5)
    )
    assert (found.value, found.order) == pytest.approx((fitted[0], fitted[2]), rel=1e-5)
    index = 1.25 * abs(found.value - values[-1])
    assert found.uncertainty - index == pytest.approx(math.sqrt(covariance[0, 0]), rel=1e-4)


def test_an_extreme_order_does_not_make_the_uncertainty_vanish():
    late = extrapolate(THREE, [1.0, 2.0, 2.001])
    assert late.flag == richardson.UNBELIEVABLE
    assert late.uncertainty > 10.0 * abs(late.value - 2.001)


def test_what_is_not_monotone_has_no_observed_order_but_a_flagged_value_with_a_given_one():
    values = [1.0, 1.3, 1.2]
    observed = extrapolate(THREE, values)
    assert observed.flag == richardson.NOT_MONOTONE
    assert np.isnan([observed.value, observed.uncertainty, observed.order]).all()
    given = extrapolate(THREE, values, 1.0)
    assert given.flag == richardson.NOT_MONOTONE
    assert given.value == pytest.approx(1.2 + (1.2 - 1.3) / (22.0 / 17.0 - 1.0))
    assert given.uncertainty > 0.0
    assert math.isnan(extrapolate(THREE, [1.0, 1.3, 1.3]).value)


@pytest.mark.parametrize("many", [3, 4])
def test_differences_that_do_not_fall_have_no_order(many):
    found = extrapolate(0.5 ** np.arange(many), 2.0 ** np.arange(many))
    assert found.flag == richardson.NO_ORDER
    assert math.isnan(found.value)


def test_an_order_that_is_hard_to_believe_is_flagged():
    spacings = 0.5 ** np.arange(3)
    for order, flag in ((0.1, richardson.UNBELIEVABLE), (9.0, richardson.UNBELIEVABLE), (7.0, "")):
        found = extrapolate(spacings, 1.0 + spacings**order)
        assert (found.order, found.flag) == (pytest.approx(order), flag)


def test_few_equal_and_repeated_values():
    two = extrapolate([0.2, 0.1], [1.4, 1.2], 1.0)
    assert two == Extrapolation(
        pytest.approx(1.0), pytest.approx(0.2), 1.0, richardson.PAIR_ONLY, (0.2, 0.1), (1.4, 1.2)
    )
    for values, order, needed in (([1.0], 1.0, 2), ([1.0, 2.0], None, 3), ([], None, 3)):
        found = extrapolate(THREE[: len(values)], values, order)
        assert found.flag == f"{richardson.TOO_FEW}: {len(values)}, {needed} are needed"
        assert np.isnan([found.value, found.uncertainty, found.order]).all()
    same = extrapolate(THREE, [4.0, 4.0, 4.0])
    assert (same.value, same.uncertainty, same.flag) == (4.0, 0.0, richardson.CONSTANT)
    repeated = extrapolate([0.2, 0.1, 0.1], [1.0, 2.0, 3.0])
    assert (math.isnan(repeated.value), repeated.flag) == (True, richardson.REPEATED)


@pytest.mark.parametrize(
    ("spacings", "values", "order"),
    [
        ([0.2, 0.1], [1.0], None),
        ([0.2, 0.0], [1.0, 2.0], 1.0),
        ([0.2, 0.1], [1.0, math.nan], 1.0),
        (THREE, THREE, 0.0),
        (THREE, THREE, -1.0),
        (THREE, THREE, math.nan),
    ],
)
def test_wrong_numbers_are_refused(spacings, values, order):
    with pytest.raises(ValueError, match="should be"):
        extrapolate(spacings, values, order)


RESOLUTIONS = (5, 7, 11)


def swept(tmp_path, *overrides):
    """A combined dataset of plates none of which has been run, with made-up numbers.

    Their spacing is 0.4/n metres; `tip` is h + Δ^h, in metres, `droop` 2 - Δ.
    """
    with session() as hydra:
        resolutions = ",".join(map(str, RESOLUTIONS))
        arguments = ["scene=plate", "h=1.3,1.5", f"n={resolutions}", *overrides]
        configs = [point.config for point in hydra.points(arguments, sweep=True)[0]]
    dataset = combine(configs, Store(tmp_path))
    dims = dataset["status"].dims
    dataset["status"][:] = STATUS.index("done")
    h, n = (dataset[key].broadcast_like(dataset["status"]).transpose(*dims) for key in ("h", "n"))
    dataset["spacing"] = (dims, (0.4 / n).data, {"units": "m", "long_name": "spacing", "group": "cost"})
    for name, values, units in (
        ("tip", h + (0.4 / n) ** h, "m"),
        ("droop", 2.0 - 0.4 / n, "1"),
    ):
        attributes = {"units": units, "long_name": f"the {name}", "group": "metric"}
        dataset[name] = (dims, values.data, attributes)
    return dataset


def test_points_that_differ_in_n_only_belong_together(tmp_path):
    found = series(swept(tmp_path, "scene.nu=0.2,0.3"), "tip")
    assert [s.place for s in found] == [{"scene.nu": u, "h": h} for u in (0.2, 0.3) for h in (1.3, 1.5)]
    for s in found:
        h = s.place["h"]
        assert s.scene == "plate"
        assert s.values == {n: pytest.approx(h + (0.4 / n) ** h) for n in RESOLUTIONS}
        assert s.extrapolation.spacings == tuple(0.4 / n for n in RESOLUTIONS)
        assert (s.extrapolation.value, s.extrapolation.order) == (pytest.approx(h), pytest.approx(h))


def test_the_dataset_of_extrapolations_has_everything_swept_but_n(tmp_path):
    given = swept(tmp_path, "scene.nu=0.2,0.3")
    result = extrapolated(given, "tip")
    assert dict(result.sizes) == {"scene.nu": 2, "h": 2}
    np.testing.assert_allclose(result["tip"].sel(h=1.3), 1.3, atol=1e-10)
    np.testing.assert_allclose(result["tip_order"].sel(h=1.5), 1.5, atol=1e-8)
    assert (result["tip_flag"] == "").all()
    assert result["tip"].attrs["units"] == result["tip_uncertainty"].attrs["units"] == "m"
    assert result.attrs["git_state"] == given.attrs["git_state"]
    assert dict(extrapolated(given.sel(h=1.5), "tip").sizes) == {"h": 1, "scene.nu": 2}
    write(result, tmp_path / "out.nc")
    assert read_dataset(str(tmp_path / "out.nc"), tmp_path).identical(result)


def test_so_has_that_of_a_list_of_points(tmp_path):
    grid = swept(tmp_path, "scene.nu=0.2,0.3")
    points = grid.stack(point=grid["status"].dims).reset_index("point").isel(point=slice(1, None))
    result = extrapolated(points, "droop", 1.0)
    assert dict(result.sizes) == {"point": 4}
    assert result["scene.nu"].values.tolist() == [0.2, 0.2, 0.3, 0.3]
    assert result["h"].values.tolist() == [1.3, 1.5, 1.3, 1.5]
    np.testing.assert_allclose(result["droop"], 2.0, rtol=1e-14)
    assert result["droop_flag"].values.tolist() == [richardson.PAIR_ONLY, "", "", ""]


def test_points_without_a_result_are_left_out_and_named(tmp_path):
    dataset = swept(tmp_path)
    dataset["status"].loc[{"h": 1.3, "n": 7}] = STATUS.index("diverged")
    dataset["tip"].loc[{"h": 1.3, "n": 7}] = math.nan
    dataset["tip"].loc[{"h": 1.5, "n": 5}] = math.nan
    dataset["spacing"].loc[{"h": 1.5, "n": 11}] = math.nan
    one, other = series(dataset, "tip", 1.3)
    assert one.extrapolation.flag == f"{richardson.PAIR_ONLY}; left out: n=7 diverged"
    assert one.extrapolation.value == pytest.approx(1.3)
    assert [n for n, value in one.values.items() if math.isnan(value)] == [7]
    told = "left out: n=5 without a value, n=11 without a spacing"
    assert other.extrapolation.flag == f"{richardson.TOO_FEW}: 1, 2 are needed; {told}"
    # A hole in the grid is no point: nothing is said of it.
    dataset["configuration"].loc[{"h": 1.3, "n": 7}] = ""
    assert series(dataset, "tip", 1.3)[0].extrapolation.flag == richardson.PAIR_ONLY


def test_datasets_that_cannot_be_extrapolated_are_refused_with_what_is_missing(tmp_path):
    dataset = swept(tmp_path)
    for wrong, metric, complaint in (
        (dataset, "tips", r"tips: there is no such metric; did you mean tip\?"),
        (dataset, "spacing", "spacing: there is no such metric; there are tip, droop"),
        (dataset.drop_vars("spacing"), "tip", "spacing: the dataset lacks the particle spacings"),
        (dataset.isel(n=[0]), "tip", "n: the dataset has 1 value of n"),
        (dataset.isel(n=0, drop=True), "tip", "n: the dataset has no n"),
        (dataset.drop_vars("configuration"), "tip", "not a combined dataset"),
        (dataset.sel(h=1.5, drop=True), "tip", "not a combined dataset"),
    ):
        with pytest.raises(ConfigurationError, match=complaint):
            series(wrong, metric)
