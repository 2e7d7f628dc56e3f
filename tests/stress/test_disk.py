"""What a disk does to a sweep: said in a line, the status is right, and nothing is lost."""

import contextlib
import errno
import os
import resource
import shutil
import time

import numpy as np
import pytest

from sphstudy.__main__ import main
from sphstudy.analysis import dataset
from sphstudy.store import atomic, netcdf, store
from sphstudy.store.checkpoint_file import CheckpointFile
from sphstudy.store.store import Store
from tests.support.made_up import TINY, Solver, points

SWEEP = ["-m", *TINY, "n=5,7", "hydra/launcher=basic"]


@pytest.fixture
def solver(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    return Solver(monkeypatch)


def statuses():
    """What the store says of n = 5 and 7, afresh."""
    fresh = Store("results")
    return [fresh.status(point.config) for point in points("n=5,7")]


def leftovers():
    return [
        p.name
        for p in Store("results").runs.iterdir()
        if p.name.startswith(".writing") or ".tmp" in p.name
    ]


@contextlib.contextmanager
def files_no_larger_than(size):
    """A disk without room, as far as a process can have one to itself."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_record_for_which_there_is_no_room_is_said_and_its_run_done_again(solver, capsys):
    with files_no_larger_than(12_000):
        assert main(SWEEP) == 1
    shown = capsys.readouterr()
    assert shown.err.count("its record could not be written (") == 2
    assert "Traceback" not in shown.err
    assert statuses() == ["missing", "missing"]
    assert leftovers() == []
    assert main(SWEEP) == 0
    assert solver.runs == [7, 5, 7, 5]
    assert statuses() == ["done", "done"]


def test_one_record_without_room_costs_no_other(solver, monkeypatch, capsys):
    real = netcdf._to_netcdf

    def full(dataset, path, **how):
        if "-n7" in dataset.attrs["title"]:
            raise OSError(errno.ENOSPC, "No space left on device")
        real(dataset, path, **how)

    monkeypatch.setattr(netcdf, "_to_netcdf", full)
    assert main(SWEEP) == 1
    shown = capsys.readouterr()
    assert "plate-tl-h1.3-n7: its record could not be written ([Errno 28] No space left" in shown.err
    assert "1 points have no record" in shown.out
    assert statuses() == ["done", "missing"]
    assert leftovers() == []


def test_a_claim_for_which_there_is_no_room_begins_no_run(solver, capsys):
    with files_no_larger_than(0):
        assert main(SWEEP) == 1
    assert solver.runs == []
    assert "Traceback" not in capsys.readouterr().err
    assert leftovers() == []
    assert main(SWEEP) == 0


def test_a_full_disk_costs_the_checkpoint_not_the_run(tmp_path, monkeypatch, capsys):
    class Small:
        def arrays(self):
            return {"x": np.ones(100)}

    keeper = CheckpointFile(tmp_path / "a.checkpoint", 0.1)
    keeper.save(Small())
    before = (tmp_path / "a.checkpoint").read_bytes()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(atomic.os, "fsync", full)
    keeper.save(Small())
    assert "a.checkpoint: not written ([Errno 28]" in capsys.readouterr().err
    assert (tmp_path / "a.checkpoint").read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.checkpoint"]


def test_a_folder_that_is_read_only_runs_nothing_and_can_be_looked_at(solver, monkeypatch, capsys):
    assert main(SWEEP) == 0
    capsys.readouterr()

    def read_only(*_, **__):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(store.tempfile, "TemporaryFile", read_only)
    assert main([*SWEEP, "seed=1"]) == 2
    assert (
        capsys.readouterr().err
        == "sphstudy: results=results: cannot be written (Read-only file system)\n"
    )
    assert len(solver.runs) == 2
    assert main(["status"]) == 0
    assert main(["prune"]) == 0
    assert "2 done" in capsys.readouterr().out


def test_a_damaged_record_on_a_read_only_disk_is_left_there_and_not_used(solver, monkeypatch, capsys):
    main(SWEEP)
    path = Store("results").record_path(points("n=5")[0].config)
    path.write_bytes(path.read_bytes()[:-100])

    def read_only(*_):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(store.os, "rename", read_only)
    assert statuses() == ["missing", "done"]
    assert "left there (Read-only file system)" in capsys.readouterr().err
    assert main(["status"]) == 0


def test_a_folder_that_is_removed_while_runs_go_on_is_made_again(solver, capsys):
    solver.deeds[5] = lambda *_: shutil.rmtree("results")
    assert main(SWEEP) == 0
    assert solver.runs == [7, 5, 7]
    shown = capsys.readouterr()
    assert "1 runs were left undone: going on with them" in shown.err
    assert "Traceback" not in shown.err
    assert statuses() == ["done", "done"]


def test_a_record_that_is_deleted_while_it_is_collected_is_missing(solver, monkeypatch, capsys):
    main(SWEEP)
    real = store.summarised
    path = Store("results").record_path(points("n=7")[0].config)

    def deleted(one):
        if one == path:
            one.unlink()
        return real(one)

    monkeypatch.setattr(store, "summarised", deleted)
    configs = [point.config for point in points("n=5,7")]
    combined = dataset.combine(configs, Store("results"))
    assert combined["status"].values.ravel().tolist() == [1, 0]
    assert capsys.readouterr().err.count("unreadable") == 0


def test_too_many_open_files_say_nothing_against_a_record(solver, monkeypatch, capsys):
    main(SWEEP)

    def too_many(_):
        raise OSError(errno.EMFILE, "Too many open files")

    monkeypatch.setattr(store, "sealed_text", too_many)
    capsys.readouterr()
    assert main(["status"]) == 2
    assert "cannot be read now (Too many open files)" in capsys.readouterr().err
    monkeypatch.undo()
    assert not list(Store("results").runs.glob("*.unreadable"))


def test_a_clock_that_is_set_back_makes_nothing_run_again(solver):
    main(SWEEP)
    future = time.time() + 1e6
    for path in Store("results").runs.glob("*.nc"):
        os.utime(path, (future, future))
    assert main(SWEEP) == 0
    assert len(solver.runs) == 2
    assert main(["--force", *SWEEP]) == 0
    assert len(solver.runs) == 4


def test_a_disk_that_takes_no_dataset_is_said(solver, monkeypatch, capsys):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device", "x.nc")

    monkeypatch.setattr(dataset.netcdf, "write", full)
    assert main(SWEEP) == 1
    assert (
        "sphstudy: [Errno 28] No space left on device: 'x.nc'; finished runs" in capsys.readouterr().err
    )
    assert statuses() == ["done", "done"]
