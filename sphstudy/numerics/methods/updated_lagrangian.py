"""The thesis formulation: updated Lagrangian SPH, symmetric momentum equation, continuity, XSPH."""

import math
from typing import Literal

import numpy as np

from sphstudy.model.problem import Problem
from sphstudy.numerics.methods.lattice import check, lattice_neighbours, support
from sphstudy.numerics.solvers.rate_system import RateSystem
from sphstudy.numerics.sph import kernel
from sphstudy.numerics.sph.artificial_stress import ArtificialStress
from sphstudy.numerics.sph.crack import Crack
from sphstudy.numerics.sph.updated_lagrangian import Model
from sphstudy.numerics.sph.viscosity import Viscosity
from sphstudy.parameters import count, described, number, parameters

__all__ = [
    "INTEGRATORS",
    "SOLVERS",
    "Parameters",
    "check",
    "lattice_neighbours",
    "memory",
    "model",
    "system",
    "wave_speed",
]

SOLVERS = ("explicit", "limit")

INTEGRATORS = ("heun",)

BYTES_PER_PARTICLE = 700
"""State, predicted state, two derivatives, pair data, sums, reference positions."""

BYTES_PER_PAIR = 24
"""Neighbour list at its largest, while it is being sorted."""


@parameters
class Parameters:
    """Every constant and open choice of the thesis formulation."""

    name: str = described("name of the method")
    kind: str = described("module that builds it")
    kernel: Literal["cubic", "wendland", "quintic"] = described(
        "cubic spline (2.7) and Wendland C2, support 2h, or quintic spline, support 3h"
    )
    xsph: float = number("µ of the smoothed velocity (2.20); 0: off", ge=0, le=1)
    viscosity_linear: float = number("α of the artificial viscosity (2.21)", ge=0)
    viscosity_quadratic: float = number("β of the artificial viscosity (2.21)", ge=0)
    artificial_stress: float = number("ζ of the artificial stress (2.25); 0: off", ge=0, le=1)
    artificial_exponent: int = count("exponent n of f_ij in (2.24)", ge=0, le=15)
    damping: float = number("velocity damping γ (2.23)", "1/s", ge=0)
    smoothing: float = number("smearing of the velocity η (2.26)", ge=0, le=1)
    spin: Literal["none", "jaumann"] = described(
        "does the stress turn with the body: not in the thesis, or by Jaumann's rate"
    )
    bulk_modulus: Literal["unprimed", "primed"] = described(
        "K of the sound speed (2.22), hence of the time step: from E, ν or from E', ν'",
    )
    constrained_smoothing: Literal["prescribed", "free"] = described(
        "smoothed velocity of constrained particles: the prescribed value, or smoothed like any other",
    )
    prescribe_again: bool = described("prescribe velocities again after the smearing (2.26)")
    visibility: Literal["inclusive", "exclusive"] = described(
        "does a pair that passes exactly through a crack node see each other (exclusive) or not",
    )
    visibility_tolerance: float = number("widening of the visibility test", gt=0, lt=1e-2)
    retest_visibility: bool = described(
        "judge visibility in the current positions at every neighbour search, or in the first"
    )
    skin: float = number("skin of the neighbour list, in particle spacings", gt=0, le=1)


def memory(particles: int, config) -> float:
    """Estimated peak memory of a run (bytes)."""
    pairs = 0.5 * particles * math.pi * (support(config) + 0.5) ** 2
    return particles * BYTES_PER_PARTICLE + pairs * BYTES_PER_PAIR


def wave_speed(config, problem: Problem) -> float:
    """c0 = √(K/ρ0) of the time step rule (2.27) [m/s]."""
    return math.sqrt(_bulk_modulus(config, problem) / problem.body.material.density)


def _bulk_modulus(config, problem: Problem) -> float:
    material = problem.body.material
    if config.method.bulk_modulus == "unprimed" or material.plane == "strain":
        return material.bulk_modulus
    e, nu = material.primed
    return e / (3.0 * (1.0 - 2.0 * nu))


def _crack(config, problem: Problem, nodes: int) -> Crack | None:
    if nodes == 0:
        return None
    method = config.method
    sign = 1.0 if method.visibility == "inclusive" else -1.0
    frozen = None if method.retest_visibility else np.stack((problem.body.x, problem.body.y))
    return Crack(
        problem.crack_first[:nodes],
        problem.crack_second[:nodes],
        sign * method.visibility_tolerance,
        frozen,
    )


def system(problem: Problem, config, dt: float, integrator: str, threads: int = 1) -> RateSystem:
    """The problem as explicit stepping takes it."""
    return RateSystem(problem, dt, lambda nodes: model(problem, config, nodes), threads)


def model(problem: Problem, config, crack_nodes: int) -> Model:
    """The right-hand side of the problem with the first `crack_nodes` nodes of its crack open."""
    method, body = config.method, problem.body
    length = config.h * body.mean_spacing
    shape = kernel.KERNELS[method.kernel]
    spacing_kernel = float(kernel.value(shape, 1.0 / config.h))
    viscous = method.viscosity_linear > 0.0 or method.viscosity_quadratic > 0.0
    return Model(
        mass=body.mass,
        kernel=shape,
        smoothing_length=length,
        normalisation=shape.normalisation(length),
        skin=method.skin * min(body.spacing_x, body.spacing_y),
        lame_modulus=body.material.lame_modulus,
        shear_modulus=body.material.shear_modulus,
        bulk_modulus=_bulk_modulus(config, problem),
        constraints=problem.constraints,
        prescribe_smoothed=method.constrained_smoothing == "prescribed",
        prescribe_again=method.prescribe_again,
        xsph=method.xsph or None,
        viscosity=Viscosity(method.viscosity_linear, method.viscosity_quadratic) if viscous else None,
        artificial=ArtificialStress(method.artificial_stress, method.artificial_exponent, spacing_kernel)
        if method.artificial_stress > 0.0
        else None,
        spin=True if method.spin == "jaumann" else None,
        damping=method.damping or None,
        smoothing=method.smoothing or None,
        crack=_crack(config, problem, crack_nodes),
    )
