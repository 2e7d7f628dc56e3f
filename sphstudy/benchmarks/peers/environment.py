"""Environments of peers: made by venv and pip, kept while they are complete, made again otherwise."""

import json
import os
import shutil
import subprocess
import sys
import venv
from collections.abc import Callable
from pathlib import Path
from typing import IO

from sphstudy.benchmarks.peers.codes import Peer

COMPLETE = "complete.json"
"""Written last: an environment without it is half-made."""


class SetupFailed(RuntimeError):
    """A peer that could not be set up; the text names the step and the log."""


def python(folder: Path) -> Path:
    """The Python of the environment in a peer's folder."""
    return folder / "environment" / "bin" / "python"


def is_complete(peer: Peer, folder: Path) -> bool:
    """Whether the environment is there, made by the same steps, and was finished."""
    try:
        made = json.loads((folder / COMPLETE).read_text())
    except (OSError, ValueError):
        return False
    return made == _steps(peer) and python(folder).exists()


def create(peer: Peer, folder: Path) -> None:
    """Makes the environment and logs it in <folder>/install.log. Raises SetupFailed."""
    log = folder / "install.log"
    venv.create(folder / "environment", with_pip=True)
    with log.open("w") as lines:
        for step in peer.installs:
            print("pip install", *step, file=lines, flush=True)
            command = [str(python(folder)), "-m", "pip", "install", *step]
            _call(command, lines, f"pip install {step[-1]}", log)
        environment = {**os.environ, **variables(folder)}
        command = [str(python(folder)), "-P", "-c", f"import {peer.module}"]
        _call(command, lines, f"import {peer.module}", log, environment)


def _call(command: list[str], lines: IO, step: str, log: Path, environment: dict | None = None) -> None:
    ended = subprocess.run(command, stdout=lines, stderr=subprocess.STDOUT, env=environment)
    if ended.returncode:
        raise SetupFailed(f"{step} ended with status {ended.returncode}, see {log}")


def variables(folder: Path) -> dict[str, str]:
    """Environment variables for a peer: its own libraries, and one thread as for every code."""
    one = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMBA")}
    return one | {"LD_LIBRARY_PATH": str((folder / "environment" / "lib").resolve())}


def ensure(peer: Peer, folder: Path, make: Callable[[Peer, Path], None] = create) -> bool:
    """Makes a peer's environment in an empty folder unless it is complete; returns whether it was made.

    Raises SetupFailed, whatever goes wrong on the way.
    """
    if is_complete(peer, folder):
        return False
    # What was measured with another environment does not hold for the new one.
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    try:
        make(peer, folder)
    except (OSError, subprocess.SubprocessError) as error:
        raise SetupFailed(f"{type(error).__name__}: {error}") from error
    (folder / COMPLETE).write_text(json.dumps(_steps(peer)))
    return True


def _steps(peer: Peer) -> dict:
    return {"python": sys.version.split()[0], "installs": [list(step) for step in peer.installs]}
