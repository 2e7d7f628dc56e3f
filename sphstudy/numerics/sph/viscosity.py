"""Monaghan's artificial viscosity (2.21)."""

from typing import NamedTuple

from sphstudy.numerics.compilation import compiled_inner


class Viscosity(NamedTuple):
    """α and β of (2.21)."""

    linear: float
    quadratic: float


@compiled_inner
def pressure(viscosity, smoothing_length, approach, distance_squared, c_sum, density_sum):
    """Π_ij ≥ 0 [m⁵/(kg s²)] from x_ij·v_ij, x_ij², c_i + c_j and ρ_i + ρ_j; zero on separation.

    It enters the momentum equation as -Π ∂W. The thesis prints +Π, which with its own Π ≥ 0 would
    feed energy in.
    """
    softened = distance_squared + 0.01 * smoothing_length * smoothing_length
    phi = smoothing_length * min(approach, 0.0) / softened
    linear, quadratic = viscosity.linear, viscosity.quadratic
    return phi * (2.0 * quadratic * phi - linear * c_sum) / density_sum
