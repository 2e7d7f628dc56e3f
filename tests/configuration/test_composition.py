"""From overrides to points: defaults, protocols, grids, and wrong input refused as a whole."""

import os

import pytest

from sphstudy import catalogue
from sphstudy.configuration.composition import SECTIONS, session
from sphstudy.configuration.execution import SETTINGS
from sphstudy.configuration.run_settings import validate
from sphstudy.errors import ConfigurationError


@pytest.fixture(scope="module")
def hydra():
    with session() as opened:
        yield opened


def test_mode_i_crack_of_the_thesis_is_the_default(hydra):
    points, results = hydra.points([], sweep=False)
    config = points[0].config
    assert (config.scene.name, config.method.name, config.solve.name) == ("mode1", "thesis", "explicit")
    assert (config.h, config.n, results) == (1.5, 40, "results")


@pytest.mark.parametrize(
    ("scene", "expected"),
    [
        ("plate", (0.8, 0.0, 0.0, 4840)),
        ("bending", (0.09, 0.7, 0.9, 4840)),
        ("mode1", (0.09, 0.05, 1.0, 8467)),
        ("mode2", (0.09, 0.05, 1.0, 8467)),
    ],
)
def test_protocol_belongs_to_scene_and_method(hydra, scene, expected):
    config = hydra.points([f"scene={scene}"], sweep=False)[0][0].config
    method, solve = config.method, config.solve
    assert (solve.courant, method.damping, method.smoothing, solve.load_steps) == expected
    assert config.method.artificial_stress == (0.3 if scene.startswith("mode") else 0.0)


def test_overrides_win_over_the_protocol(hydra):
    config = hydra.points(["solve.courant=0.05", "scene=mode2"], sweep=False)[0][0].config
    assert config.solve.courant == 0.05


def test_a_grid_is_every_combination(hydra):
    points, _ = hydra.points(["h=1.3,1.5,1.7,1.9", "n=40,50,60"], sweep=True)
    assert {(p.config.h, p.config.n) for p in points} == {
        (h, n) for h in (1.3, 1.5, 1.7, 1.9) for n in (40, 50, 60)
    }


def test_ranges_do_not_make_two_coordinates_of_one(hydra):
    points, _ = hydra.points(["h=range(1.3,2.0,0.1)"], sweep=True)
    assert [p.config.h for p in points] == [1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9]


def test_scenes_can_be_swept_and_each_keeps_its_protocol(hydra):
    points, _ = hydra.points(["scene=plate,bending"], sweep=True)
    assert [p.config.solve.courant for p in points] == [0.8, 0.09]


WRONG = [
    (["h=-1"], "h=-1: should be greater than 0"),
    (["h=nan"], "h=nan: should be a finite number"),
    (["h=inf"], "h=inf: should be a finite number"),
    (["h=0.4"], "h=0.4: too few neighbours"),
    (["n=0"], "n=0: should be greater than or equal to 1"),
    (["n=4.5"], "n=4.5: should be a valid integer"),
    (["n=41"], "n=41: must be even in mode1"),
    (["scene=plate", "n=20"], "n=20: must be odd in plate"),
    (["scene=bending", "n=20"], "n=20: must be odd in bending"),
    (["n=1000000"], "n=1000000: 1,000,000,000,000 particles need about 1 PiB of memory"),
    (["n=10"], "n=10: must be at least 12 in mode1"),
    (["scene=foo"], "unknown scene 'foo'; there are bending, "),
    (["scene=mode3"], "unknown scene 'mode3'; did you mean 'mode"),
    (["hh=1.3"], "hh=1.3: unknown setting 'hh'; did you mean 'h'? There are "),
    (["scene.E=-5"], "scene.E=-5: should be greater than 0"),
    (["scene.nu=0.5"], "scene.nu=0.5: should be less than 0.5"),
    (["scene.EE=1"], "did you mean 'scene.E'"),
    (["scene.plane=strain"], "scene.plane=strain: should be 'stress'"),
    (["h=1.3,1.5"], "h=1.3,1.5: several values make a sweep: add -m"),
    (["h=1.3", "h=1.5"], "h is given twice"),
    (["+x=1"], "cannot be added"),
    (["~h"], "cannot be added, deleted or moved"),
    (["h=[1"], "not understood"),
    (["scene={kind:os}"], "unknown scene '{'kind': 'os'}'; there are"),
    (["scene.kind=../os"], "is not the name of a module"),
    (["results=${oc.env:HOME}"], "interpolations are not taken"),
    (["hydra.run.dir=/tmp"], "of Hydra's own keys"),
    (["record.samples=3"], "record.samples=3: should be greater than or equal to 10"),
    (["record.times=[x]"], "record.times.0=x: should be a valid number"),
    (["threads=0"], "threads=0: should be greater than or equal to 1"),
    (["threads=1.5"], "threads=1.5: should be a valid integer"),
    (["checkpoint=0"], "checkpoint=0: should be greater than 0"),
    (["time_limit=-1"], "time_limit=-1: should be greater than 0"),
    (["memory_limit=x"], "memory_limit=x: should be a valid number"),
    (["h=1e9", "n=20"], "h=1e+09: the support is wider than the body's 20 rows"),
    (["h=1e308"], "h=1e+308: should be 0, or 1e-50 to 1e+50 in size"),
    (["scene.E=5e-324"], "scene.E=4.94066e-324: should be 0, or 1e-50 to 1e+50 in size"),
    (["solve.load_steps=9223372036854775807"], "should be less than or equal to 1000000000"),
    ([f"n={'9' * 400}"], f"n={'9' * 60}…: should be less than or equal to 1000000000"),
    (["memory_limit=1e10"], "memory_limit=10000000000.0: should be less than or equal to 1000000"),
    (["time_limit=1e10"], "time_limit=10000000000.0: should be less than or equal to 1000000000"),
    (["retry=often"], "unknown retry 'often'; there are none, failed, timeout, all"),
    (["scene.name=mine"], "scene.name=mine: the name is that of the file; scene=NAME chooses another"),
    (["known=1"], "known=1: unknown setting 'known'"),
    (["h=25"], "the support is wider than the body"),
]


@pytest.mark.parametrize(("overrides", "complaint"), WRONG, ids=[" ".join(o) for o, _ in WRONG])
def test_wrong_input_names_key_value_and_what_is_allowed(hydra, overrides, complaint):
    with pytest.raises(ConfigurationError) as error:
        hydra.points(overrides, sweep=False)
    assert complaint in str(error.value)
    assert len(error.value.complaints) <= 2


def test_threads_are_for_runs_by_steps_and_make_no_other_point(hydra, monkeypatch):
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    (one,), _ = hydra.points(["scene=plate", "n=5"], sweep=False)
    (two,), _ = hydra.points(["scene=plate", "n=5", "threads=2"], sweep=False)
    assert (one.execution.threads, two.execution.threads) == (1, 2)
    assert one.config == two.config
    with pytest.raises(ConfigurationError, match="threads=2: solver modes runs on one thread"):
        hydra.points(["scene=plate", "n=5", "method=tl", "solve=modes", "threads=2"], sweep=False)
    with pytest.raises(ConfigurationError, match="threads=3: this machine has 2 cores"):
        hydra.points(["scene=plate", "n=5", "threads=3"], sweep=False)


def test_one_bad_point_refuses_the_whole_grid(hydra):
    with pytest.raises(ConfigurationError, match="n=41: must be even"):
        hydra.points(["h=1.3,1.5", "n=40,41"], sweep=True)


def test_groups_are_composed_once_and_values_set_on_a_copy(hydra):
    """The same as composing it all."""
    from hydra.types import RunMode
    from omegaconf import OmegaConf

    overrides = ["scene=spin", "h=1.7", "n=50", "scene.nu=0.25", "record.times=[0.1]", "results=x"]
    whole = OmegaConf.to_container(hydra._loader.load_configuration("config", overrides, RunMode.RUN))
    values = {k: v for k, v in whole.items() if k not in ("hydra", *SETTINGS, *SECTIONS)}
    for part, name in (("scene", "spin"), ("method", "thesis"), ("solve", "explicit")):
        values[part]["name"] = name
    assert validate(values) == hydra.points(overrides, sweep=False)[0][0].config


@pytest.mark.parametrize("scene", catalogue.names("scene"))
def test_the_catalogue_inherits_as_hydra_does(hydra, scene):
    from hydra.types import RunMode
    from omegaconf import OmegaConf

    config = hydra._loader.load_configuration("config", [f"scene={scene}"], RunMode.RUN)
    whole, found = OmegaConf.to_container(config), dict(catalogue.settings("scene", scene))
    record, whole["scene"]["name"] = found.pop("record", {}), scene
    assert whole["record"] == {**whole["record"], **record}
    assert {key: whole[key] for key in found} == found


@pytest.mark.parametrize("scene", catalogue.names("scene"))
def test_every_list_of_a_scene_names_modules_of_metrics(scene):
    assert all(catalogue.module("metrics", name) for name in catalogue.metrics(scene))
    assert catalogue.headline(scene, "explicit")
    assert catalogue.headline(scene, "limit")[0] == "largest_stable_courant"
