"""How far runs have come: a small file beside each record in the making."""

import json
import os
import platform
import time
from contextlib import suppress
from pathlib import Path

_INTERVAL = 0.5


class Marker:
    """The running.json of one run: who computes it, since when, and how far it is."""

    def __init__(self, path: Path):
        self.path = path
        self._started = time.time()
        self._written = 0.0

    def __enter__(self) -> "Marker":
        self._write(0, 0)
        return self

    def __exit__(self, *exception) -> None:
        self.path.unlink(missing_ok=True)

    def update(self, step: int, steps: int) -> None:
        """Notes the step reached, at most twice a second."""
        if time.monotonic() - self._written >= _INTERVAL:
            self._write(step, steps)

    def _write(self, step: int, steps: int) -> None:
        self._written = time.monotonic()
        note = {
            "step": step,
            "steps": steps,
            "process": os.getpid(),
            "host": platform.node(),
            "started": self._started,
        }
        temporary = self.path.with_suffix(f".{os.getpid()}.tmp")
        with suppress(OSError):
            temporary.write_text(json.dumps(note))
            os.replace(temporary, self.path)


def read_marker(path: Path) -> dict | None:
    """What a running.json says, or None."""
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return None


def is_alive(note: dict) -> bool:
    """Whether the process that wrote a marker still runs; assumed so on another machine."""
    if note["host"] != platform.node():
        return True
    try:
        os.kill(note["process"], 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
