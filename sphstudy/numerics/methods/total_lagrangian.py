"""Total Lagrangian SPH: variational, corrected, without hourglass modes."""

import math
from collections.abc import Iterator
from typing import Literal

import numpy as np

from sphstudy.model.problem import Problem
from sphstudy.numerics.methods import lattice
from sphstudy.numerics.methods.lattice import lattice_neighbours, support
from sphstudy.numerics.solvers.potential_system import PotentialSystem
from sphstudy.numerics.solvers.potential_system import highest_frequency as _highest_frequency
from sphstudy.numerics.sph import constitutive, kernel, total_lagrangian
from sphstudy.numerics.sph.contact import Surfaces
from sphstudy.numerics.sph.crack import Crack
from sphstudy.numerics.sph.total_lagrangian import Model
from sphstudy.numerics.sph.viscosity import Viscosity
from sphstudy.parameters import described, number, parameters

__all__ = [
    "INTEGRATORS",
    "SOLVERS",
    "Parameters",
    "check",
    "highest_frequency",
    "lattice_neighbours",
    "memory",
    "model",
    "system",
    "wave_speed",
]

SOLVERS = ("explicit", "equilibrium", "modes", "limit")

_ASSEMBLING = ("equilibrium", "modes")
"""Solvers that need the stiffness as a matrix."""

INTEGRATORS = ("verlet", "heun")

BYTES_PER_PARTICLE = 500
"""State, buffers, reference configuration, fields."""

BYTES_PER_PAIR = 150
"""Bonds, and the pairs one by one while totals are taken."""

STIFFNESS_BYTES = 3000
"""Of the stiffness and its intermediate products per particle and squared support in spacings."""

FACTOR_BYTES = 45
"""Of the factor of a square body per particle^1.5 and support in spacings: a band of two supports."""


@parameters
class Parameters:
    """Every choice of the total Lagrangian method."""

    name: str = described("name of the method")
    kind: str = described("module that builds it")
    kernel: Literal["cubic", "wendland", "quintic"] = described(
        "cubic spline (2.7) and Wendland C2, support 2h, or quintic spline, support 3h"
    )
    law: Literal["linear", "svk", "neohookean"] = described(
        "linear Hooke, as linear references have it; St Venant-Kirchhoff; compressible neo-Hookean"
    )
    hourglass: float = number("ζ of the hourglass energy; 0 leaves zero-energy modes", ge=0)
    viscosity_linear: float = number("α of the artificial viscosity (2.21)", ge=0)
    viscosity_quadratic: float = number("β of the artificial viscosity (2.21)", ge=0)
    damping: float = number("velocity damping γ (2.23)", "1/s", ge=0)
    contact_stiffness: float = number(
        "κ of the contact between surfaces, f = 3κ(λ + 2µ) d0 (1 - r/d0)²; 0: they pass through", ge=0
    )
    contact_range: float = number(
        "d0 of contact, in particle spacings; below 2 facing rows slip", gt=0, le=5
    )
    visibility_tolerance: float = number("widening of the inclusive visibility test", gt=0, lt=1e-2)


def check(config) -> Iterator[str]:
    """Complaints about h and n, and about contact where nothing knows its stiffness."""
    yield from lattice.check(config)
    if config.method.contact_stiffness > 0.0 and config.solve.name == "equilibrium":
        yield (
            f"method.contact_stiffness={config.method.contact_stiffness:g}: solve=equilibrium knows no "
            "contact; take explicit"
        )


def memory(particles: int, config) -> float:
    """Estimated peak memory of a run (bytes)."""
    reach = support(config)
    pairs = 0.5 * particles * math.pi * reach**2
    needed = particles * BYTES_PER_PARTICLE + pairs * BYTES_PER_PAIR
    if config.solve.name in _ASSEMBLING:
        needed += STIFFNESS_BYTES * reach**2 * particles + FACTOR_BYTES * reach * particles**1.5
    return needed


def wave_speed(config, problem: Problem) -> float:
    """c0 = √(K/ρ0) of the time step rule (2.27) [m/s]."""
    return problem.body.material.wave_speed


def highest_frequency(problem: Problem, config) -> float:
    """ω_max [rad/s] of the problem before any crack is extended: cutting bonds lowers it."""
    return _highest_frequency(model(problem, config, problem.stages[0].crack_nodes))


def system(problem: Problem, config, dt: float, integrator: str, threads: int = 1) -> PotentialSystem:
    """The problem as explicit stepping takes it."""
    return PotentialSystem(problem, dt, lambda nodes: model(problem, config, nodes), integrator, threads)


def model(problem: Problem, config, crack_nodes: int) -> Model:
    """The energy of the problem with the first `crack_nodes` nodes of its crack open."""
    method, body = config.method, problem.body
    crack = None
    if crack_nodes:
        # Inclusive: on a lattice every pair straight across the crack passes exactly through a node, and
        # the exclusive test would leave them all, hence no crack.
        nodes = problem.crack_first[:crack_nodes], problem.crack_second[:crack_nodes]
        crack = Crack(*nodes, method.visibility_tolerance)
    viscous = method.viscosity_linear > 0.0 or method.viscosity_quadratic > 0.0
    surfaces = None
    if method.contact_stiffness > 0.0:
        strength = method.contact_stiffness * (
            body.material.lame_modulus + 2.0 * body.material.shear_modulus
        )
        reach = method.contact_range * body.mean_spacing
        index = np.flatnonzero(body.surface)
        surfaces = Surfaces(strength, reach, index, body.x, body.y, body.part)
    return total_lagrangian.model(
        body.x,
        body.y,
        body.mass,
        body.material.density,
        kernel.KERNELS[method.kernel],
        config.h * body.mean_spacing,
        constitutive.law(method.law, body.material),
        problem.constraints,
        hourglass=method.hourglass,
        crack=crack,
        viscous=Viscosity(method.viscosity_linear, method.viscosity_quadratic) if viscous else None,
        damping=method.damping,
        wave_speed=body.material.wave_speed,
        part=body.part,
        surfaces=surfaces,
    )
