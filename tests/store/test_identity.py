"""The key of a run: what changes it and what does not."""

import pytest

from sphstudy.configuration.composition import session
from sphstudy.numerics import version
from sphstudy.store import identity


@pytest.fixture(scope="module")
def config_of():
    with session() as hydra:
        yield lambda *overrides: hydra.points(list(overrides), sweep=False)[0][0].config


def test_everything_that_determines_the_numbers_changes_the_key(config_of):
    variants = [
        (),
        ("h=1.6",),
        ("n=50",),
        ("scene=mode2",),
        ("scene.nu=0.31",),
        ("method.skin=0.2",),
        ("solve.settle_steps=4001",),
        ("record.samples=500",),
        ("record.times=[0.5]",),
        ("seed=1",),
    ]
    keys = [identity.key(config_of(*overrides)) for overrides in variants]
    assert len(set(keys)) == len(variants)


def test_where_it_is_stored_and_how_it_is_written_do_not(config_of):
    key = identity.key(config_of())
    assert identity.key(config_of("results=elsewhere")) == key
    assert identity.key(config_of("h=1.50", "scene.E=6.0e6")) == key
    assert identity.key(config_of("h=1.5000000000000002")) == key


def test_the_version_of_metrics_covers_what_measures_and_nothing_else(config_of):
    files = {path.stem for path in identity._measuring(identity.PACKAGE / "metrics" / "oscillation.py")}
    assert "beam" in files
    assert "williams" not in files
    plate, crack = config_of("scene=plate"), config_of()
    assert identity.metrics_version(plate) != identity.metrics_version(crack)
    assert identity.metrics_version(plate) == identity.metrics_version(config_of("scene=plate", "n=11"))


def test_all_runs_of_unchanged_sources_have_the_number_as_their_version(config_of):
    number = config_of("scene=plate"), config_of("scene=plate", "method=tl"), config_of()
    assert {identity.numerics_version(config) for config in number} == {str(_number())}


def _number() -> int:
    return version._recorded()[0]
