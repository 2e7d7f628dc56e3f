"""Batch studies with smoothed particle hydrodynamics of elastic solids and fracture."""

__version__ = "0.1.0"
__all__ = ["__version__", "open", "run", "sweep"]


def __getattr__(name: str):
    # Imported on first use: the command line answers --help and Ctrl-C without loading any library, which
    # is why not even typing is imported here.
    if name in ("open", "run", "sweep"):
        from sphstudy import api

        return getattr(api, name)
    raise AttributeError(f"module 'sphstudy' has no attribute {name!r}")
