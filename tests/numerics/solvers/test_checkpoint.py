"""A run that is stopped and goes on from its checkpoint is the uninterrupted one, to the last bit."""

import numpy as np
import pytest

from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import session
from sphstudy.numerics.solvers import explicit
from sphstudy.numerics.solvers.checkpoint import Checkpoint, NoKeeper
from sphstudy.store.checkpoint_file import CheckpointFile

CRACK = [
    "scene=mode1", "n=16", "solve.load_steps=150", "solve.settle_steps=170", "solve.extend_steps=60",
    "record.samples=11", "record.times=[0.0, 0.004]", "scene.K=1e5",
]  # fmt: skip
PLATE = ["scene=plate", "n=5", "scene.periods=0.05", "record.times=[0.1]", "record.samples=10"]


class Stop(Exception):
    """The power cut of this test."""


class Switch(NoKeeper):
    """Goes on from `kept`; takes a checkpoint at its `countdown`-th chance, and then cuts the power."""

    def __init__(self, countdown, kept=None):
        self.countdown, self.kept = countdown, kept

    def load(self):
        return self.kept

    def due(self):
        self.countdown -= 1
        return self.countdown == 0

    def save(self, checkpoint):
        # Through arrays, as through a file: nothing may be shared with the run that ends here.
        arrays = {name: values.copy() for name, values in checkpoint.arrays().items()}
        self.kept = Checkpoint.from_arrays(arrays)
        raise Stop


def solved(settings, keeper):
    with session() as hydra:
        (point,), _ = hydra.points(settings, sweep=False)
    scene, method = scene_module(point.config.scene.kind), method_module(point.config.method.kind)
    return explicit.run(scene.build(point.config), point.config, method, lambda *_: None, keeper)


TOTAL = [
    "scene=mode2", "method=tl", "n=16", "solve.load_steps=150", "solve.settle_steps=170",
    "solve.extend_steps=160", "record.samples=11", "record.times=[0.0, 0.004]",
]  # fmt: skip
HEUN = [*PLATE, "method=tl", "method.law=svk", "method.viscosity_linear=1", "solve.integrator=heun"]


@pytest.fixture(params=[CRACK, PLATE, TOTAL, HEUN], ids=["crack", "plate", "total", "heun"])
def whole(request):
    return request.param, solved(request.param, NoKeeper())


@pytest.mark.parametrize("countdown", [1, 3])
def test_restarted_run_is_bit_identical(whole, countdown):
    settings, expected = whole
    switch, cuts, solution = Switch(countdown), 0, None
    while solution is None:
        try:
            solution = solved(settings, switch)
        except Stop:
            cuts += 1
            switch = Switch(countdown + cuts, switch.kept)
    assert cuts >= 2
    assert solution.steps == expected.steps
    assert solution.stage_steps == expected.stage_steps
    np.testing.assert_array_equal(np.array(solution.history), np.array(expected.history))
    assert [s.label for s in solution.snapshots] == [s.label for s in expected.snapshots]
    for one, other in zip(solution.snapshots, expected.snapshots, strict=True):
        assert (one.time, one.step) == (other.time, other.step)
        np.testing.assert_array_equal(one.fields, other.fields)
        assert one.strain_energy == other.strain_energy
        np.testing.assert_equal(one.closure_work, other.closure_work)


@pytest.fixture
def checkpoint(whole):
    switch = Switch(2)
    with pytest.raises(Stop):
        solved(whole[0], switch)
    return switch.kept


def test_file_keeps_every_field(tmp_path, checkpoint):
    keeper = CheckpointFile(tmp_path / "run.checkpoint", 1e-9)
    assert keeper.load() is None
    assert keeper.due()
    keeper.save(checkpoint)
    again = CheckpointFile(keeper.path, 60.0)
    loaded = again.load()
    assert loaded.arrays().keys() == checkpoint.arrays().keys()
    for name, values in checkpoint.arrays().items():
        np.testing.assert_array_equal(loaded.arrays()[name], values, err_msg=name)
    assert again.wall_seconds > 0.0
    assert not again.due()
    again.remove()
    assert list(tmp_path.iterdir()) == []


def test_damaged_file_is_said_and_ignored(tmp_path, checkpoint, capsys):
    keeper = CheckpointFile(tmp_path / "run.checkpoint", 60.0)
    keeper.save(checkpoint)
    keeper.path.write_bytes(keeper.path.read_bytes()[:-100])
    assert keeper.load() is None
    assert "the run starts anew" in capsys.readouterr().err


def test_failed_write_leaves_the_old_file(tmp_path, checkpoint, monkeypatch):
    keeper = CheckpointFile(tmp_path / "run.checkpoint", 60.0)
    keeper.save(checkpoint)
    before = keeper.path.read_bytes()

    def full(file, **arrays):
        file.write(b"half")
        raise OSError("no space left")

    monkeypatch.setattr(np, "savez", full)
    keeper.save(checkpoint)
    assert keeper.path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == [keeper.path.name]


def test_full_disk_costs_the_checkpoint_not_the_run(tmp_path, checkpoint, monkeypatch, capsys):
    keeper = CheckpointFile(tmp_path / "run.checkpoint", 60.0)

    def full(file, **arrays):
        raise OSError("no space left")

    monkeypatch.setattr(np, "savez", full)
    keeper.save(checkpoint)
    assert "the run goes on" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_empty_file_is_said_and_ignored(tmp_path, capsys):
    keeper = CheckpointFile(tmp_path / "run.checkpoint", 60.0)
    keeper.path.touch()
    assert keeper.load() is None
    assert "the run starts anew" in capsys.readouterr().err


class Album(NoKeeper):
    """Keeps every checkpoint it can get."""

    def __init__(self):
        self.kept = []

    def due(self):
        return True

    def save(self, checkpoint):
        arrays = {name: values.copy() for name, values in checkpoint.arrays().items()}
        self.kept.append(Checkpoint.from_arrays(arrays))


def test_every_sample_is_a_chance_and_none_leaves_a_second_snapshot():
    """Also where a compiled call reaches from one sample to the next, as in all short runs."""
    album = Album()
    expected = solved(PLATE, album)
    samples = [int(step) for step in np.array(expected.history)[:, 1]]
    event = next(s.step for s in expected.snapshots if s.label.startswith("t="))
    assert {*samples[:-1], event} <= {kept.step for kept in album.kept}
    for kept in album.kept:
        solution = solved(PLATE, Switch(10**9, kept))
        assert [s.step for s in solution.snapshots] == [s.step for s in expected.snapshots], kept.step
        np.testing.assert_array_equal(np.array(solution.history), np.array(expected.history))
