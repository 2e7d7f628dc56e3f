"""Damping of velocities, -γ v (2.23)."""

from sphstudy.numerics.compilation import compiled_inner


@compiled_inner
def add(damping, velocity_x, velocity_y, acceleration_x, acceleration_y):
    """Adds -γ v to the accelerations [N] (m/s²); `damping` γ (1/s), or None."""
    if damping is None:
        return
    for i in range(acceleration_x.size):
        acceleration_x[i] -= damping * velocity_x[i]
        acceleration_y[i] -= damping * velocity_y[i]


@compiled_inner
def rate(damping):
    """γ (1/s); 0 if it is None."""
    return 0.0 if damping is None else damping
