"""A disk that is full, and one that is read-only, for real: a small file system in memory, as root.

`python -m tests.stress.disk` sweeps into a file system without room for all records, makes room, goes on,
and compares with a sweep that had room; then it makes the file system read-only and looks at it. What
needs no root is in test_disk.py.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from tests.stress.kills import SWEEP, command, contents, finished


def said(folder: Path, arguments: tuple[str, ...] = SWEEP) -> tuple[int, str]:
    """Exit status and words of the program with its results in a folder."""
    beside = folder.parent / "words"
    beside.mkdir(exist_ok=True)
    with open(beside / "said.txt", "wb") as words:
        status = subprocess.run(
            [sys.executable, "-m", "sphstudy", *arguments, f"results={folder}"],
            stdout=words,
            stderr=words,
            timeout=300,
        ).returncode
    return status, (beside / "said.txt").read_text(errors="replace")


def mount(folder: Path, options: str) -> None:
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], check=True)


def full_and_read_only(place: Path) -> None:
    """Raises AssertionError where the program does not keep what it says."""
    whole, small = place / "whole", place / "small"
    whole.mkdir()
    small.mkdir()
    assert command(SWEEP, whole).wait() == 0
    expected = contents(whole)
    mount(small, "size=400k")
    try:
        status, words = said(small)
        print(words)
        assert status == 1, status
        assert "Traceback" not in words
        assert "could not be written" in words or "No space left" in words
        before = finished(small)
        assert 0 < len(before) < len(finished(whole)), before
        assert not list((small / "runs").glob(".writing-*"))
        assert not list((small / "runs").glob("*.unreadable"))
        mount(small, "remount,size=50m")
        status, words = said(small)
        assert status == 0, words
        after = finished(small)
        assert {name: after[name] for name in before} == before, "what was finished is left as it was"
        assert contents(small) == expected
        mount(small, "remount,ro")
        status, words = said(small, (*SWEEP, "seed=1"))
        print(words)
        assert (status, "Traceback" in words) == (2, False), words
        assert "cannot be written (Read-only file system)" in words
        for looking in ("status", "prune"):
            status, words = said(small, (looking,))
            assert status == 0, words
        assert finished(small) == after
    finally:
        subprocess.run(["umount", "-l", str(small)], check=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        full_and_read_only(Path(name))
    print("full, and read-only: nothing lost")
