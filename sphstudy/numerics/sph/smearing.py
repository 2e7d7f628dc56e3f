"""Smearing of velocities at the begin of a step, v ← (1-η) v + η ṽ (2.26)."""

from sphstudy.numerics.compilation import compiled_inner


@compiled_inner
def smear(smoothing, smooth_x, smooth_y, velocity_x, velocity_y):
    """Draws velocities [N] (m/s) to the smoothed ones by the share `smoothing`, η."""
    for i in range(velocity_x.size):
        velocity_x[i] += smoothing * (smooth_x[i] - velocity_x[i])
        velocity_y[i] += smoothing * (smooth_y[i] - velocity_y[i])
