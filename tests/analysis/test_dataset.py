"""Which keys become dimensions, and how the table of a sweep is filled."""

import numpy as np
import pytest
import xarray as xr

from sphstudy.analysis import dataset
from sphstudy.analysis.cells import cells
from sphstudy.analysis.dimensions import dimensions
from sphstudy.configuration.composition import session
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store


@pytest.fixture(scope="module")
def configs_of():
    with session() as hydra:
        yield lambda *overrides: [p.config for p in hydra.points(list(overrides), sweep=True)[0]]


def flat(configs):
    return [config.flat() for config in configs]


def test_h_and_n_are_always_dimensions(configs_of):
    assert dimensions(flat(configs_of())) == {"h": [1.5], "n": [40]}


def test_what_is_swept_is_a_dimension_sorted_if_numeric(configs_of):
    swept = dimensions(flat(configs_of("solve.courant=0.3,0.1", "n=60,40")))
    assert swept == {"solve.courant": [0.1, 0.3], "h": [1.5], "n": [40, 60]}


def test_what_only_follows_from_the_scene_is_none(configs_of):
    swept = dimensions(flat(configs_of("scene=mode1,mode2", "h=1.3,1.5")))
    assert swept == {"scene": ["mode1", "mode2"], "h": [1.3, 1.5], "n": [40]}


def test_lists_and_switches_can_be_swept(configs_of):
    swept = dimensions(flat(configs_of("method.prescribe_again=true,false", "record.times=[0.1],[0.2]")))
    assert swept["method.prescribe_again"] == [True, False]
    assert swept["record.times"] == ["[0.1]", "[0.2]"]


def test_points_without_a_record_are_missing_not_absent(configs_of, tmp_path):
    configs = configs_of("scene=plate", "h=1.3,1.5", "n=5,7")
    store = Store(tmp_path)
    combined = dataset.combine(configs, store)
    assert dict(combined.sizes) == {"h": 2, "n": 2}
    assert (combined["status"] == STATUS.index("missing")).all()
    assert not list(tmp_path.iterdir())
    assert dataset.write(combined, configs, store).is_file()
    np.testing.assert_array_equal(combined["status"].attrs["flag_values"], np.arange(len(STATUS)))


def test_a_sparse_study_is_a_list_of_points(configs_of, tmp_path):
    base = ["scene=plate", "n=5"]
    options = ["method.xsph=0.4", "scene.nu=0.2", "scene.columns=spacing", "method.damping=0.1"]
    options += ["scene.E=2e6", "scene.H0=0.01", "method.skin=0.2"]
    configs = configs_of(*base) + [config for o in options for config in configs_of(*base, o)]
    combined = dataset.combine(configs, Store(tmp_path))
    assert dict(combined.sizes) == {"point": 8}
    with xr.open_dataset(dataset.write(combined, configs, Store(tmp_path), "sparse")) as stored:
        assert (
            stored["scene.columns"].values.tolist() == ["linspace"] * 3 + ["spacing"] + ["linspace"] * 4
        )
    found = cells(combined)
    assert [cell.flat for cell in found] == [config.flat() for config in configs]
    assert found[2].place["scene.nu"] == 0.2


def test_cells_of_a_grid_are_its_points_only(configs_of, tmp_path):
    configs = configs_of("scene=plate", "h=1.3", "n=5,7") + configs_of("scene=plate", "h=1.5", "n=5")
    combined = dataset.combine(configs, Store(tmp_path))
    assert dict(combined.sizes) == {"h": 2, "n": 2}
    assert {cell.label for cell in cells(combined)} == {"h=1.3 n=5", "h=1.3 n=7", "h=1.5 n=5"}
    with pytest.raises(ValueError, match="not a combined dataset"):
        cells(combined.drop_vars("configuration"))
