"""Prescribed motion: which degrees of freedom are held or driven, and where to."""

from typing import NamedTuple

import numpy as np


class Constraints(NamedTuple):
    """Degrees of freedom whose displacement is target · s(t); all others are free.

    `x_index`, `y_index`: particles constrained in x, in y; `x_target`, `y_target`: their displacements
    (m) at amplitude s = 1.
    """

    x_index: np.ndarray
    x_target: np.ndarray
    y_index: np.ndarray
    y_target: np.ndarray
