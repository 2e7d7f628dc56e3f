"""Reading never writes: metrics of an older version are measured in memory, and a line says so."""

import math

import pytest

from sphstudy import catalogue
from sphstudy.__main__ import main
from sphstudy.analysis.points_table import points_table
from sphstudy.analysis.results import load
from sphstudy.configuration.composition import session
from sphstudy.running.one_run import computed
from sphstudy.store import netcdf
from sphstudy.store.store import Store
from tests.support.made_up import points

STUDY = "title: tiny\nblocks: {grid: {scene: plate, method: tl, h: 1.3, n: 5, scene.periods: 0.01}}\n"


@pytest.fixture
def stored(tmp_path, monkeypatch):
    """A store with one record whose metrics are of an older version and wrong; its configuration, and
    today's metrics. Nothing can be written to it any more.
    """
    (tmp_path / "tiny.yaml").write_text(STUDY)
    monkeypatch.setitem(catalogue.FOLDERS, "studies", tmp_path)
    monkeypatch.chdir(tmp_path)
    (point,) = points("n=5")
    store = Store("results")
    run = computed(point.config, store, point.execution)
    today = {str(name): float(v) for name, v in run.items() if v.attrs.get("group") == "metric"}
    for name in today:
        run[name] = run[name].copy(data=1e6)
    run.attrs["metrics_version"] = "older"
    store.keep(point.config, run)

    def read_only(*_, **__):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(netcdf, "replacing", read_only)
    return store, point.config, {name: v for name, v in today.items() if not math.isnan(v)}


def files(store):
    return {path: path.read_bytes() for path in store.folder.rglob("*") if path.is_file()}


def test_metrics_of_an_older_version_are_measured_in_memory_and_said_once(stored, capsys):
    store, config, today = stored
    before = files(store)
    for _ in range(2):
        (row,) = points_table([config], store, "tiny").rows
        assert {name: row[name] for name in today} == today
    assert files(store) == before
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert "1 record" in lines[0]
    assert "`sphstudy measure tiny`" in lines[0]


def test_a_study_is_read_and_judged_from_a_folder_that_cannot_be_written(stored, capsys):
    store, _, today = stored
    before = files(store)
    with session() as hydra:
        found = load("tiny", hydra, [])
    assert {name: found.value(name) for name in today} == today
    assert {name: float(found.record()[name]) for name in today} == today
    assert main(["judge", "tiny"]) in (0, 1)
    assert files(store) == before
    assert capsys.readouterr().err.count("sphstudy measure tiny") == 1


def test_a_record_that_proves_damaged_when_it_is_measured_is_set_aside_and_missing(stored, capsys):
    store, config, _ = stored
    path = store.record_path(config)
    data = bytearray(path.read_bytes())
    data[700] ^= 1
    path.write_bytes(data)
    assert store.summary(config).status == "done"  # its summary is whole
    (row,) = points_table([config], store).rows
    assert row["status"] == "missing"
    assert store.status(config) == "missing"
    assert path.with_suffix(".unreadable").exists()
    assert "not those that were written" in capsys.readouterr().err
