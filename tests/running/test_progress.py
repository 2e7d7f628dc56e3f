"""What is told of a sweep while it goes on, from the files that runs leave."""

import shutil

import pytest

from sphstudy.configuration.composition import session
from sphstudy.running.one_run import give_up
from sphstudy.running.progress import _Board
from sphstudy.store.store import Store


@pytest.fixture
def board(tmp_path):
    store = Store(tmp_path)
    store.prepare()
    with session() as hydra:
        points, _ = hydra.points(["scene=plate", "n=5,7", "h=1.3"], sweep=True)
    give_up(points[0].config, store, "failed", "before")
    return _Board([(point.config, 1.0) for point in points], store, reused=0)


def end(board, number):
    follower = board.followers[number]
    give_up(follower.config, follower.store, "failed", "why")


def test_each_run_is_told_once_when_its_record_is_new(board):
    assert list(board.news()) == [], "a record from before is no news"
    for number in (1, 0):
        end(board, number)
        [line] = board.news()
        assert board.followers[number].config.label in line
        assert "failed (why)" in line
    assert list(board.news()) == []
    assert board.finished == 2


def test_a_folder_that_is_gone_is_no_news(board):
    shutil.rmtree(board.folder)
    assert list(board.news()) == []
