"""The vibrating plate of a nearly incompressible material: whether it locks, and what its pressure does."""

from sphstudy.scenes.plate import Parameters, build, check, particles

__all__ = ["HEADLINE", "METRICS", "Parameters", "build", "check", "particles"]

METRICS = ("oscillation", "pressure", "regularity", "balance")
HEADLINE = (
    "frequency_error_2d",
    "pressure_checkerboard",
    "amplitude_frequency_product",
    "fit_residual",
    "energy_drift",
)
