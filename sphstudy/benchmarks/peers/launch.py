"""A run of a driver in a process of its own."""

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sphstudy.benchmarks.peers import environment
from sphstudy.benchmarks.peers.codes import THIS

DRIVERS = Path(__file__).parent / "drivers"

LONGEST = 1800.0
"""Wall time (s) after which a run is given up."""


@dataclass(frozen=True)
class Outcome:
    """status: done, diverged, failed, timeout; values: what the driver left; message: why nothing."""

    status: str
    values: dict[str, Any]
    message: str = ""


def launch(peer: str, folder: Path, settings: dict[str, Any], longest: float = LONGEST) -> Outcome:
    """Runs the driver of a peer with the Python in its folder. What goes wrong is an outcome.

    settings: as the driver takes them; `speed_limit` (m/s): a run that ends faster has diverged.
    """
    with tempfile.TemporaryDirectory(prefix="peer-") as scratch:
        output, given = Path(scratch) / "output.json", Path(scratch) / "settings.json"
        given.write_text(json.dumps({**settings, "output": str(output)}))
        interpreter = sys.executable if peer == THIS else str(environment.python(folder).absolute())
        variables = os.environ | environment.variables(folder)
        if peer == THIS:
            root = str(Path(__file__).parent.parent.parent.parent)
            variables["PYTHONPATH"] = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
        log = folder / "run.log"
        folder.mkdir(parents=True, exist_ok=True)
        try:
            with log.open("w") as lines:
                ended = subprocess.run(
                    [interpreter, "-P", str(DRIVERS / f"{peer}.py"), str(given)],
                    stdout=lines,
                    stderr=subprocess.STDOUT,
                    env=variables,
                    timeout=longest,
                )
        except subprocess.TimeoutExpired:
            return Outcome("timeout", {}, f"given up after {longest:g} s")
        except OSError as error:
            return Outcome("failed", {}, f"{interpreter}: {error.strerror}")
        if ended.returncode or not output.exists():
            kept = log.replace(folder / "failed.log")
            return Outcome("failed", {}, f"ended with status {ended.returncode}, see {kept}")
        values = json.loads(output.read_text())
    return Outcome("done" if _sound(values, settings["speed_limit"]) else "diverged", values)


def _sound(values: dict[str, Any], speed_limit: float) -> bool:
    if "frequency" in values:
        return True
    return values["largest_speed"] is not None and values["largest_speed"] < speed_limit
