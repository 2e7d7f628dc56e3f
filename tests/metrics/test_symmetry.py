"""Parity of stresses on fields with known answers."""

import numpy as np
import pytest

from sphstudy.metrics import symmetry
from tests.metrics.test_fracture import crack_record

COMPONENTS = ("xx", "yy", "xy")


@pytest.mark.parametrize("mode", [1, 2])
def test_the_exact_field_has_its_parity(mode):
    found = symmetry.measure(*crack_record(mode))
    assert len(found) == 6
    for name, metric in found.items():
        assert metric.value == pytest.approx(0.0, abs=1e-12), name


@pytest.mark.parametrize("mode", [1, 2])
def test_the_field_of_the_other_mode_is_the_wrong_part(mode):
    """Modes mixed half and half over: the defect is the ratio of the two fields' sizes."""
    run, config = crack_record(mode)
    other, _ = crack_record(3 - mode)
    x0, y0 = run["reference_x"].values, run["reference_y"].values
    disc = np.hypot(x0, y0) < 0.025
    ahead = (x0 > 0.0) & (x0 < 0.025) & (np.abs(y0) < 0.01)
    mixed = run.copy()
    for c in COMPONENTS:
        mixed[f"stress_{c}"] = run[f"stress_{c}"] + 0.5 * other[f"stress_{c}"]
    found = symmetry.measure(mixed, config)
    for c in COMPONENTS:
        for suffix, chosen in (("", disc), ("_ahead", ahead)):
            right, wrong = (r[f"stress_{c}"].values[1][chosen] for r in (run, other))
            expected = 0.5 * np.sqrt(np.mean(wrong**2) / np.mean(right**2))
            assert found[f"stress_{c}_parity_defect{suffix}"].value == pytest.approx(expected, rel=1e-9)


def test_only_the_neighbourhood_of_the_tip_counts():
    run, config = crack_record(2)
    far = np.hypot(run["reference_x"].values, run["reference_y"].values) > 0.026
    run["stress_xx"].values[:, far] = 1e6
    assert symmetry.measure(run, config)["stress_xx_parity_defect"].value == pytest.approx(0.0, abs=1e-12)


def test_parts_by_hand():
    field = np.array([[3.0, 0.0], [1.0, 0.0]])
    chosen = np.array([[True, False], [True, False]])
    assert symmetry.parity(field, True, chosen) == (2.0, 1.0)
    assert symmetry.parity(field, False, chosen).defect == 2.0


def test_a_field_without_the_right_part_has_no_defect():
    assert np.isnan(symmetry.parity(np.zeros((2, 2)), True, np.ones((2, 2), bool)).defect)
