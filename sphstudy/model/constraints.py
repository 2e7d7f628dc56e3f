"""Prescribed motion: which degrees of freedom are held or driven, and where to."""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled_inner


class Constraints(NamedTuple):
    """Degrees of freedom whose displacement is target · s(t); all others are free.

    `x_index`, `y_index`: particles constrained in x, in y; `x_target`, `y_target`: their displacements
    (m) at amplitude s = 1.
    """

    x_index: np.ndarray
    x_target: np.ndarray
    y_index: np.ndarray
    y_target: np.ndarray


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
