"""Compiled code computes the same bits whoever compiled it, and when; nobody else can put any there."""

import os
import subprocess
import sys
import tempfile

import pytest

from sphstudy.numerics import compilation
from tests.stress.kills import contents

RUNS = {
    "thesis": ("scene=mode1", "n=16"),
    "tl": ("scene=rings", "method=tl", "n=6"),
}


def records(folder, cache, *settings):
    """What a run leaves that a process of its own does, with its compiled code in a folder."""
    folder.mkdir()
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    subprocess.run(
        [sys.executable, "-m", "sphstudy", *settings, f"results={folder}"],
        env={**environment, "XDG_CACHE_HOME": str(cache)},
        check=True,
        capture_output=True,
    )
    return contents(folder)


@pytest.mark.slow
@pytest.mark.parametrize("settings", RUNS.values(), ids=RUNS)
def test_code_just_compiled_or_cached_or_for_two_threads_gives_the_same_bits(tmp_path, settings):
    cache = tmp_path / "cache"
    compiling = records(tmp_path / "compiling", cache, *settings)
    assert len(compiling) == 2
    assert list(cache.rglob("*.nbc")), "compiled there"
    assert records(tmp_path / "loading", cache, *settings) == compiling
    assert records(tmp_path / "threads", cache, *settings, "threads=2") == compiling


@pytest.fixture
def shared(tmp_path, monkeypatch):
    """Temporary files where anybody may write, while the user's own cache takes nothing."""
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/nowhere")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    tmp_path.chmod(0o1777)
    return tmp_path


def test_in_a_place_that_all_share_the_cache_is_this_users_alone(shared):
    previous = os.umask(0)
    try:
        folder = compilation._cache_folder()
    finally:
        os.umask(previous)
    root = shared / f"sphstudy-cache-{os.getuid()}"
    assert folder == root / compilation.source_hash()
    assert root.stat().st_mode & 0o777 == 0o700
    assert compilation._cache_folder() == folder, "there already"


def test_a_cache_of_somebody_else_is_refused(shared, monkeypatch):
    uid = os.getuid()
    (shared / f"sphstudy-cache-{uid + 1}").mkdir(mode=0o700)
    monkeypatch.setattr(os, "getuid", lambda: uid + 1)
    with pytest.raises(PermissionError, match="set NUMBA_CACHE_DIR"):
        compilation._cache_folder()


@pytest.mark.parametrize("mode", [0o770, 0o702])
def test_a_cache_that_others_may_write_to_is_refused(shared, mode):
    root = shared / f"sphstudy-cache-{os.getuid()}"
    root.mkdir()
    root.chmod(mode)
    with pytest.raises(PermissionError, match="set NUMBA_CACHE_DIR"):
        compilation._cache_folder()
    assert list(root.iterdir()) == []


def test_a_link_in_place_of_the_cache_is_refused(shared):
    (shared / "elsewhere").mkdir(mode=0o700)
    (shared / f"sphstudy-cache-{os.getuid()}").symlink_to(shared / "elsewhere")
    with pytest.raises(PermissionError, match="set NUMBA_CACHE_DIR"):
        compilation._cache_folder()


def test_the_users_own_cache_comes_first(shared, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(shared / "own"))
    assert compilation._cache_folder().parent == shared / "own" / "sphstudy"
    assert not list(shared.glob("sphstudy-cache-*"))
