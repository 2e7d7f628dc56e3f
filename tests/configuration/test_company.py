"""Composition in company: in threads, in another program's Hydra, with equal values and odd folders."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from hydra import compose, initialize_config_dir
from hydra.version import getbase

import sphstudy
from sphstudy.configuration.composition import session
from tests.support.made_up import TINY, Solver

SETTINGS = dict(setting.split("=") for setting in TINY)


def test_threads_run_at_once_within_another_hydra(tmp_path, monkeypatch):
    """As a program does that optimises with several threads and has settings of its own."""
    monkeypatch.chdir(tmp_path)
    Solver(monkeypatch)
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "own.yaml").write_text("a: 1\n")
    with initialize_config_dir(str(tmp_path / "theirs"), version_base="1.2"):
        with ThreadPoolExecutor(4) as pool:
            runs = list(pool.map(lambda n: sphstudy.run(n=n, **SETTINGS), range(5, 21, 2)))
        assert compose("own") == {"a": 1}
        assert str(getbase()) == "1.2"
    assert [float(run["error"]) for run in runs] == [0.1] * 8
    assert len(list((tmp_path / "results" / "runs").glob("*.nc"))) == 8


@pytest.mark.parametrize(
    ("swept", "count"),
    [
        ("h=1.3,1.30,1.3e0,1.5", 2),
        ("method.visibility_tolerance=1e-05,0.00001", 1),
        ("h=1.3,1.4,1.5", 3),
        ("scene.nu=0.3,0.30000000000000004", 1),
    ],
)
def test_equal_values_are_one(swept, count, capsys):
    with session() as hydra:
        points, _ = hydra.points(["scene=plate", "method=tl", "n=5", swept], sweep=True)
    assert len(points) == count
    left_out = len(swept.split(",")) - count
    said = capsys.readouterr().err
    assert (f"{left_out} point" in said) == (left_out > 0)


@pytest.mark.parametrize(
    "folder",
    [
        "jürgen/x",
        "a b",
        "a,b",
        "a=b",
        "[x]",
        "{x}",
        "#x",
        "it's",
        "end\\",
        "a\\'b",
        "null",
        "1.5",
        "a\nb",
        "*",
    ],
)
def test_any_folder_takes_results(folder):
    with session() as hydra:
        arguments = ["scene=plate", "method=tl", "n=5", "h=1.3", f"results={folder}"]
        assert hydra.points(arguments, sweep=False)[1] == folder
