"""Compiled code computes the same bits whoever compiled it, and when."""

import os
import subprocess
import sys

import pytest

from tests.faults.kills import contents

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
