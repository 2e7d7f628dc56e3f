"""Sums over the body that tell whether a run is sound: momenta, energies, spacing, work."""

from typing import NamedTuple


class Invariants(NamedTuple):
    """Totals per thickness of one state."""

    system_speed: float
    momentum_x: float
    momentum_y: float
    angular_momentum: float
    kinetic_energy: float
    strain_energy: float
    largest_speed: float
    smallest_spacing: float
    net_internal_force: float
    constraint_power: float
