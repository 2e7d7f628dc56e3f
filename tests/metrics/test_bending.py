"""Boundary effects of the bent centreline on curves with known answers."""

import numpy as np
import pytest

from sphstudy.metrics.bending import boundary_roughness

X = np.linspace(0.0, 1.0, 101)
ZIGZAG = 1e-4 * (-1.0) ** np.arange(X.size)


def values(error, length=1.0, x0=X):
    found = boundary_roughness(x0, error, length)
    return {name.removeprefix("centreline_roughness_"): metric.value for name, metric in found.items()}


def test_a_smooth_error_however_large_makes_no_jag():
    """A parabola of the size of the deflection: half its second difference, c Δx²."""
    found = values(0.04 * X**2)
    assert list(found) == ["wall", "middle", "end"]
    assert list(found.values()) == pytest.approx([0.04 * 0.01**2] * 3)


@pytest.mark.parametrize(
    ("part", "where"),
    [("wall", X < 0.1), ("middle", (X > 0.2) & (X < 0.8)), ("end", X > 0.95)],
)
def test_a_zigzag_is_found_where_it_is(part, where):
    found = values(np.where(where, ZIGZAG, 0.0))
    for other, value in found.items():
        assert value == pytest.approx(2e-4 if other == part else 0.0, abs=1e-15)


def test_parts_are_shares_of_the_length():
    found = values(np.where(X < 0.1, ZIGZAG, 0.0), length=2.0, x0=2.0 * X)
    assert found["wall"] == pytest.approx(2e-4)
    assert found["middle"] == pytest.approx(0.0, abs=1e-15)


def test_a_part_without_particles_is_left_out():
    assert list(values(np.zeros(4), x0=np.array([0.0, 0.4, 0.8, 1.0]))) == ["middle"]
