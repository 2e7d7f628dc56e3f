"""Without UTF-8: files are read as UTF-8 all the same, and output is what the terminal can show."""

import os
import subprocess
import sys

import pytest

ASCII = {
    **os.environ,
    "LC_ALL": "C",
    "PYTHONUTF8": "0",
    "PYTHONCOERCECLOCALE": "0",
    "PYTHONIOENCODING": "",
}

SWEEP = "-m scene=plate method=tl n=5 h=1.3 scene.periods=0.02"


@pytest.mark.parametrize(
    "line", ["list", "describe scene plate", "--help", f"{SWEEP}", "status", "prune"]
)
def test_a_command_works_in_ascii(line, tmp_path):
    (tmp_path / "results" / "runs").mkdir(parents=True)
    command = [sys.executable, "-m", "sphstudy", *line.split()]
    done = subprocess.run(command, capture_output=True, cwd=tmp_path, env=ASCII, check=False)
    said = done.stdout.decode("ascii") + done.stderr.decode("ascii")
    assert done.returncode == 0, said
    assert "Traceback" not in said
    if line == SWEEP:
        assert len(list((tmp_path / "results" / "runs").glob("*.nc"))) == 1


def test_what_a_terminal_lacks_is_spelled():
    """In a process that prints in ASCII, and in one whose terminal has some of it."""
    text = "−1.2×10³ Δx, ν = 0.3 → ∞ …"
    program = (
        "from sphstudy.console import write_what_the_terminal_has;"
        f"write_what_the_terminal_has(); print({text!r})"
    )
    for encoding, shown in (
        ("ascii", "-1.2x103 deltax, nu = 0.3 -> inf ..."),
        ("latin-1", "-1.2×10³ deltax, nu = 0.3 -> inf ..."),
        ("utf-8", text),
    ):
        done = subprocess.run(
            [sys.executable, "-c", program],
            capture_output=True,
            env={**os.environ, "PYTHONIOENCODING": encoding},
            check=True,
        )
        assert done.stdout.decode(encoding).strip() == shown
