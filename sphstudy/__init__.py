"""Batch studies with smoothed particle hydrodynamics of elastic solids and fracture."""

__version__ = "0.1.0"
