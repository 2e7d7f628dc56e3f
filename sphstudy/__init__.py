"""Batch studies with smoothed particle hydrodynamics of elastic solids and fracture."""

from typing import Any

__version__ = "0.1.0"
__all__ = ["__version__", "open", "run", "sweep"]


def __getattr__(name: str) -> Any:
    # Imported on first use: the command line answers --help without loading any library.
    if name in ("open", "run", "sweep"):
        from sphstudy import api

        return getattr(api, name)
    raise AttributeError(f"module 'sphstudy' has no attribute {name!r}")
