"""The vibrating plate of a nearly incompressible material: does it lock, and what of its pressure?"""

from sphstudy.model.scenes.plate import Parameters, build, check, particles

__all__ = ["HEADLINE", "METRICS", "Parameters", "build", "check", "particles"]

METRICS = ("oscillation", "pressure", "regularity", "balance")
HEADLINE = (
    "frequency_error_2d",
    "pressure_checkerboard",
    "pressure_stripes",
    "amplitude_frequency_product",
    "fit_residual",
    "energy_drift",
)
