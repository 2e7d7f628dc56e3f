"""Which keys become dimensions, and how the table of a sweep is filled."""

import numpy as np
import pytest

from sphstudy import collect
from sphstudy.composition import session
from sphstudy.record import STATUS
from sphstudy.store import Store


@pytest.fixture(scope="module")
def configs_of():
    with session() as hydra:
        yield lambda *overrides: [p.config for p in hydra.points(list(overrides), sweep=True)[0]]


def test_h_and_n_are_always_dimensions(configs_of):
    assert collect.dimensions(configs_of()) == {"h": [1.5], "n": [40]}


def test_what_is_swept_is_a_dimension_sorted_if_numeric(configs_of):
    swept = collect.dimensions(configs_of("solve.courant=0.3,0.1", "n=60,40"))
    assert swept == {"solve.courant": [0.1, 0.3], "h": [1.5], "n": [40, 60]}


def test_what_only_follows_from_the_scene_is_none(configs_of):
    swept = collect.dimensions(configs_of("scene=mode1,mode2", "h=1.3,1.5"))
    assert swept == {"scene": ["mode1", "mode2"], "h": [1.3, 1.5], "n": [40]}


def test_lists_and_switches_can_be_swept(configs_of):
    swept = collect.dimensions(
        configs_of("method.prescribe_again=true,false", "record.times=[0.1],[0.2]")
    )
    assert swept["method.prescribe_again"] == [True, False]
    assert swept["record.times"] == ["[0.1]", "[0.2]"]


def test_points_without_a_record_are_missing_not_absent(configs_of, tmp_path):
    configs = configs_of("scene=plate", "h=1.3,1.5", "n=5,7")
    dataset, path = collect.collect(configs, Store(tmp_path))
    assert dict(dataset.sizes) == {"h": 2, "n": 2}
    assert (dataset["status"] == STATUS.index("missing")).all()
    assert path.is_file()
    np.testing.assert_array_equal(dataset["status"].attrs["flag_values"], np.arange(len(STATUS)))
