"""The vibrating plate swinging for long, or far: its swings are looked at one by one as well."""

from sphstudy.model.scenes.plate import Parameters, build, check, particles

__all__ = ["HEADLINE", "METRICS", "Parameters", "build", "check", "particles"]

METRICS = ("oscillation", "swings", "period", "regularity", "balance")
HEADLINE = (
    "amplitude_loss_per_period",
    "amplitude_frequency_product",
    "period",
    "period_error_2d",
    "fit_residual",
    "energy_drift",
    "smallest_spacing",
)
