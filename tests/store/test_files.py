"""Files in a folder of runs: those of other programs stay as they are, odd ones are named, none hangs."""

import os
import stat

import numpy as np
import pytest

from sphstudy.__main__ import main
from sphstudy.numerics.solvers.checkpoint import Checkpoint
from sphstudy.running.one_run import compute
from sphstudy.store.atomic import replacing
from sphstudy.store.checkpoint_file import CheckpointFile
from sphstudy.store.store import Store
from sphstudy.text import short_name
from tests.support.made_up import Solver, points

SETTINGS = ("scene=plate", "method=tl", "n=5")


@pytest.fixture
def store(tmp_path, monkeypatch):
    """A folder with the record of one run, made by a solver that takes no time."""
    monkeypatch.chdir(tmp_path)
    Solver(monkeypatch)
    (point,) = points("n=5")
    store = Store("results")
    compute(point.config, store, point.execution)
    return store, point


def checkpoint():
    state = np.arange(12.0).reshape(6, 2)
    return Checkpoint(
        0, 0, 7, float("nan"), state, state, *(np.zeros(0) for _ in range(6)), 0, 0.0, np.zeros((8, 2)), 3
    )


def test_files_of_other_programs_stay_as_they_are(store, capsys):
    store, _ = store
    others = [
        store.runs / name for name in ("climate.nc", "server.log", "x.running.json", "a.unreadable")
    ]
    for path in others:
        path.write_text("another program's")
    for command in (["status"], ["prune"], ["prune", "--yes"], ["adopt"]):
        assert main(command) == 0
    assert [path.read_text() for path in others] == ["another program's"] * len(others)
    said = capsys.readouterr()
    assert "climate" not in said.out + said.err


@pytest.mark.parametrize("suffix", [".nc", ".checkpoint", ".log", ".running.json"])
@pytest.mark.parametrize("kind", ["pipe", "folder", "device"])
def test_what_is_no_file_is_no_hang(store, suffix, kind, capsys):
    store, point = store
    path = store.record_path(point.config).with_suffix(suffix)
    path.unlink(missing_ok=True)
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    else:
        path.symlink_to("/dev/zero")
    assert main(["status"]) == 0
    assert main(["prune"]) == 0
    if (kind, suffix) != ("folder", ".running.json"):
        compute(point.config, store, point.execution, store.stamp(point.config))
        assert store.status(point.config) == "done"


def test_a_checkpoint_with_any_byte_changed_is_named_and_not_gone_on_from(tmp_path, capsys):
    file = CheckpointFile(tmp_path / "run.checkpoint", 0.0)
    file.save(checkpoint())
    whole = file.path.read_bytes()
    assert CheckpointFile(file.path, 0.0).load().step == 7
    for position in range(0, len(whole), 5):
        data = bytearray(whole)
        data[position] ^= 1 << position % 8
        file.path.write_bytes(data)
        assert CheckpointFile(file.path, 0.0).load() is None, position
        assert "run.checkpoint: unreadable" in capsys.readouterr().err
    for end in (0, 1, 100, len(whole) - 1):
        file.path.write_bytes(whole[:end])
        assert CheckpointFile(file.path, 0.0).load() is None


def test_a_claim_lost_beside_its_record_goes_with_the_next_sweep(store):
    store, point = store
    claim = store.claim_path(point.config)
    claim.write_text("{}")
    assert main(["status"]) == 0
    assert claim.exists(), "reading changes nothing"
    assert main([*SETTINGS, "results=results"]) == 0
    assert not claim.exists()


@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_files_have_the_mode_that_umask_leaves(tmp_path, mask, mode):
    before = os.umask(mask)
    try:
        with replacing(tmp_path / "file") as temporary:
            temporary.write_text("x")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "file").stat().st_mode) == mode


def test_a_name_too_long_for_a_file_is_cut_and_stays_its_own():
    long, other = ("study-" + "h=1.3,1.4,1.5" * 30 + end for end in ("a", "b"))
    assert len(short_name(long)) <= 120
    assert short_name(long) != short_name(other)
    assert short_name("study-h=1.3") == "study-h=1.3"
    assert len(short_name("ü" * 200).encode()) <= 120
