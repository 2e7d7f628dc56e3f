"""The references as stored: whole, of committed sources, and no wider than the open choices allow."""

import math

import pytest

from sphstudy.analysis import reference
from sphstudy.analysis.cells import cells
from sphstudy.analysis.effects import CONTROL
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.configuration.study_points import StudyPoints

STORED = ("plate", "bending", "mode1", "mode2", "small", "choices")


@pytest.mark.parametrize(
    ("name", "resolutions"), [("plate", (9, 15, 21)), ("mode1", (40, 50, 60)), ("mode2", (40, 50, 60))]
)
def test_all_twelve_cells_are_there(name, resolutions):
    done = {(c.flat["h"], c.flat["n"]) for c in cells(reference.load(name)) if c.status == "done"}
    assert done == {(h, n) for h in (1.3, 1.5, 1.7, 1.9) for n in resolutions}


@pytest.mark.parametrize("name", STORED)
def test_each_comes_from_committed_sources_and_says_from_what(name):
    attributes = reference.load(name).attrs
    assert len(attributes["git_state"]) == 40
    for key in ("sphstudy_version", "library_versions", "processor", "python_version"):
        assert attributes[key]


@pytest.fixture(scope="module")
def smallest_effects():
    """Of each metric: the smallest effect of an open choice that is not rounding (of what the control
    does, or of the metric's largest value), found without the product's own code for it.
    """
    stored = cells(reference.load("choices"))
    # Settings that came after the reference was stored have had one value ever since. Others have moved
    # to another section, and count by their own name.
    own = lambda flat: sorted((key.rpartition(".")[2], str(v)) for key, v in flat.items())  # noqa: E731
    known = {key for cell in stored for key, _ in own(cell.flat)}
    name = lambda flat: tuple(item for item in own(flat) if item[0] in known)  # noqa: E731
    points = {name(cell.flat): cell for cell in stored}
    metrics, found = reference.metrics(reference.load("choices")), {}
    size = {
        m: max(abs(c.values[m]) for c in points.values() if c.values[m] == c.values[m]) for m in metrics
    }
    with session() as hydra:
        blocks = StudyPoints(hydra, "choices", []).blocks
    for block in blocks.values():
        base, *others = (points[name(p.config.flat())] for p in block)
        (control,) = [o for o in others if o.flat[CONTROL] != base.flat[CONTROL]]
        for metric in metrics:
            noise = abs(control.values[metric] - base.values[metric])
            for other in others:
                effect = abs(other.values[metric] - base.values[metric])
                if other is not control and effect > max(100.0 * noise, 1e-9 * size[metric]):
                    found[metric] = min(effect, found.get(metric, math.inf))
    return found


@pytest.mark.parametrize("name", STORED)
def test_no_interval_is_wider_than_three_times_the_smallest_effect(name, smallest_effects):
    stored = reference.load(name)
    judged = 0
    for metric in reference.metrics(stored):
        tolerance = reference.tolerance(stored, metric)
        if tolerance is not None and "half of the smallest effect" in tolerance.reason:
            assert 2.0 * tolerance.half_width <= 3.0 * smallest_effects[metric], metric
            judged += 1
    assert judged > 10


def test_what_sits_in_the_instability_is_named_with_a_reason():
    named = study_file.load("plate").unstable
    assert [dict(entry.where) for entry in named] == [{"h": 1.3, "n": [15, 21]}]
    assert all(entry.reason for entry in named)


def test_the_values_that_the_thesis_prints_are_ranges_of_metrics_that_exist():
    for entry in reference.printed():
        assert entry.lower < entry.upper
        assert entry.source
        assert entry.metric in reference.metrics(reference.load(entry.study))
