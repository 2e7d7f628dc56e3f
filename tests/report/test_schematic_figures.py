"""Figures of chapters 2 and 3 draw without a single record, and show what the scenes are made of."""

import matplotlib.style
import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from sphstudy.analysis import results
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.model.exact import beam
from sphstudy.numerics.sph.crack import visible
from sphstudy.report import figure
from sphstudy.report.drawing import built, first_configuration, footprints
from sphstudy.report.figures import crack_geometry, method, plate_geometry

DRAWN_FROM = {"method": "plate", "plate_geometry": None, "crack_geometry": "mode1"}
FIGURES = {
    definition: DRAWN_FROM[module.__name__.rpartition(".")[2]]
    or ("plate" if definition.number in ("3.1", "3.2") else "bending")
    for module in (method, plate_geometry, crack_geometry)
    for definition in figure.defined(module)
}


@pytest.fixture(scope="module")
def empty(tmp_path_factory):
    """Results of the thesis's studies from a store that holds nothing."""
    folder = str(tmp_path_factory.mktemp("empty"))
    with session() as hydra:
        return {name: results.load(name, hydra, [], folder) for name in ("plate", "bending", "mode1")}


@pytest.fixture
def draw(empty):
    def drawn(definition) -> Figure:
        with matplotlib.style.context(figure.STYLE):
            drawing = definition.draw(empty[FIGURES[definition]])
            drawing.canvas.draw()
        return drawing

    return drawn


def points(axes, label):
    """Coordinates [2, M] of the lines with this label in these axes, together."""
    lines = [line for line in axes.get_lines() if line.get_label() == label]
    return np.concatenate([line.get_xydata() for line in lines]).T


@pytest.mark.parametrize("definition", FIGURES, ids=lambda definition: definition.number)
def test_every_figure_draws_and_its_study_lists_it(definition, draw):
    drawing = draw(definition)
    assert drawing.axes
    for axes in drawing.axes:
        assert axes.get_xlabel() or axes.get_shared_x_axes().get_siblings(axes) != [axes]
    assert definition.name in study_file.load(FIGURES[definition]).figures


def test_the_kernel_and_the_gaussian_have_area_one_and_the_same_spread(draw):
    axes = draw(method.kernel).axes[0]
    (q, shape), (_, gaussian) = (line.get_data() for line in axes.get_lines())
    assert np.trapezoid(shape, q) == pytest.approx(1.0, abs=1e-6)
    assert np.trapezoid(gaussian, q) == pytest.approx(1.0, abs=1e-4)
    assert np.trapezoid(q**2 * shape, q) == pytest.approx(1.0 / 3.0, abs=1e-5)
    assert np.trapezoid(q**2 * gaussian, q) == pytest.approx(1.0 / 3.0, abs=1e-3)
    assert shape.max() == pytest.approx(2.0 / 3.0)


def test_neighbours_are_those_inside_the_support(draw, empty):
    plan, profile = draw(method.discretised_sum).axes
    neighbours = points(plan, "neighbour of i")
    distance = np.hypot(*neighbours)
    config = first_configuration(empty["plate"], "plate")
    # Strictly inside 2.6 spacings there are 8 nearest, 4 at two spacings and 8 at √5.
    assert config.h == 1.3
    assert neighbours.shape[1] == 20
    assert distance.max() < 2.0 < np.hypot(*points(plan, "outside the support")).min()
    np.testing.assert_allclose(np.sort(profile.get_lines()[1].get_xdata()), np.sort(distance))


def test_the_verdicts_of_the_visibility_figure_are_those_of_the_method(draw):
    axes = draw(method.crack_segments).axes[1]
    node_x, node_y = points(axes, "crack segment")
    eye = points(axes, "particle i")[:, 0]
    verdicts = {
        label: [visible(*eye, *point, node_x, node_y, 1e-9) for point in points(axes, label).T]
        for label in ("neighbour of i", "hidden from i")
    }
    assert len(verdicts["neighbour of i"]) > 5
    assert all(verdicts["neighbour of i"])
    assert len(verdicts["hidden from i"]) > 2
    assert not any(verdicts["hidden from i"])


def test_crack_nodes_lie_half_way_between_the_marked_pairs(draw):
    axes = draw(method.crack_segments).axes[0]
    nodes = points(axes, "crack segment")
    carriers = points(axes, "carries a node")
    assert carriers.shape[1] == 2 * nodes.shape[1]
    # Rows of particles come in order, so that pairs come apart; each node halves one of the distances.
    middles = 0.5 * (carriers[:, :, None] + carriers[:, None, :])
    for node in nodes.T:
        assert np.isclose(middles, node[:, None, None]).all(axis=0).any()


def test_fixed_particles_are_the_constrained_ones(draw, empty):
    problem = built(first_configuration(empty["plate"], "plate"), 9)
    for axes in draw(plate_geometry.particles_of_plate).axes:
        fixed, tracked, free = (points(axes, kind) for kind in ("fixed", "tracked", "free"))
        assert fixed.shape[1] == problem.constraints.x_index.size
        assert (fixed[0] == 0.0).all()
        np.testing.assert_array_equal(
            tracked[:, 0], (problem.body.x[problem.tracked], problem.body.y[problem.tracked])
        )
        assert fixed.shape[1] + tracked.shape[1] + free.shape[1] == problem.body.x.size


def test_the_prescribed_column_is_driven_to_its_targets(draw, empty):
    config = first_configuration(empty["bending"], "bending")
    problem = built(config, 9)
    axes = draw(plate_geometry.prescribed_end).axes[0]
    driven = points(axes, "prescribed in y")
    assert driven.shape[1] == problem.body.tags["end"].sum()
    assert driven[1].mean() == pytest.approx(problem.constraints.y_target.min())
    assert points(axes, "fixed").shape[1] == problem.constraints.x_index.size


def test_the_fitted_line_shows_the_end_angle_of_the_beam(draw, empty):
    config = first_configuration(empty["bending"], "bending")
    spacing = built(config, 9).body.spacing_x
    axes = draw(plate_geometry.end_angle).axes[0]
    (x0, x1), (y0, y1) = points(axes, "fitted line")
    theta = beam.end_angle(4 * config.scene.deflection * config.scene.L, config.scene.L, spacing)
    assert (x1 - x0) / (y1 - y0) == pytest.approx(-theta, rel=1e-6)


def test_the_frame_is_marked_as_prescribed_and_the_crack_reaches_the_middle(draw):
    axes = draw(crack_geometry.setup).axes[0]
    frame, free = points(axes, "prescribed"), points(axes, "free")
    side = round(np.sqrt(frame.shape[1] + free.shape[1]))
    assert free.shape[1] == (side - 4) ** 2
    spacing = 0.2 / side
    crack = points(axes, "crack")
    np.testing.assert_allclose(crack[1], 0.0, atol=1e-15)
    assert crack[0].min() == pytest.approx(-0.1 + 0.5 * spacing)
    assert crack[0].max() == pytest.approx(-0.5 * spacing)


def test_mode_i_opens_the_frame_and_mode_ii_slides_it(draw):
    for axes, sign in zip(draw(crack_geometry.frame_displacements).axes, (1, -1), strict=True):
        before, after = points(axes, "at the start"), points(axes, "displaced")
        across = after[1] - before[1]
        face = (before[0] < -0.08) & (np.abs(before[1]) < 0.008)
        above, below = face & (before[1] > 0), face & (before[1] < 0)
        opening = across[above].mean() - across[below].mean()
        sliding = (after - before)[0][above].mean() - (after - before)[0][below].mean()
        assert abs(opening) > abs(sliding) if sign > 0 else abs(sliding) > abs(opening)
        assert (opening if sign > 0 else sliding) > 0.0


def test_marked_particles_lie_beside_the_crack_and_ahead_of_it(draw):
    for axes, side in zip(draw(crack_geometry.marked_particles).axes, (-1, 1), strict=True):
        free, driven = points(axes, "marked, free"), points(axes, "marked, prescribed")
        marked = np.concatenate((free, driven), axis=1)
        assert (side * marked[0] > 0.0).all()
        assert driven.shape[1] == 4
        everything = marked.shape[1] + points(axes, "not marked").shape[1]
        assert marked.shape[1] == round(np.sqrt(everything))


def test_each_opening_adds_a_node_and_hides_pairs(draw):
    panels = draw(crack_geometry.forced_opening).axes
    tips = [points(axes, "crack, its nodes")[0].max() for axes in panels]
    spacing = tips[1] - tips[0]
    np.testing.assert_allclose(tips, [-0.5 * spacing, 0.5 * spacing, 1.5 * spacing])
    joined = [sum(line.get_color() == "C5" for line in axes.get_lines()) for axes in panels]
    # The pair at the new tip, and the two diagonals that the crack comes to cross.
    np.testing.assert_array_equal(np.diff(joined), [-3, -3])


def test_footprints_are_rectangles_of_one_cell_each():
    axes = Figure().add_subplot()
    drawn = footprints(axes, [0.0, 2.0], [0.0, 1.0], 2.0, 1.0, [3.0, 4.0], clim=(0.0, 5.0))
    assert isinstance(drawn, PolyCollection)
    first, second = (path.get_extents() for path in drawn.get_paths())
    assert (first.width, first.height) == (2.0, 1.0)
    assert (second.x0, second.y0) == (1.0, 0.5)
    assert drawn.get_clim() == (0.0, 5.0)
    low, high = axes.get_xlim()
    assert low <= -1.0
    assert high >= 3.0
