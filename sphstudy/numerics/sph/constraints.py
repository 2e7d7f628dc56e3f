"""Prescribed motion in compiled code (model.constraints)."""

from sphstudy.numerics.compilation import compiled_inner


@compiled_inner
def prescribe(constraints, velocity_x, velocity_y, amplitude_rate):
    """Sets the velocities (m/s) of constrained degrees of freedom to target · s'(t)."""
    for k in range(constraints.x_index.size):
        velocity_x[constraints.x_index[k]] = constraints.x_target[k] * amplitude_rate
    for k in range(constraints.y_index.size):
        velocity_y[constraints.y_index[k]] = constraints.y_target[k] * amplitude_rate


@compiled_inner
def release(constraints, acceleration_x, acceleration_y):
    """Zeroes what would accelerate constrained degrees of freedom."""
    for k in range(constraints.x_index.size):
        acceleration_x[constraints.x_index[k]] = 0.0
    for k in range(constraints.y_index.size):
        acceleration_y[constraints.y_index[k]] = 0.0
