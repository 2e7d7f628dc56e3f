"""Free square set spinning as if it were rigid: several turns about its centre, with nothing to hold it.

The start of a rotation is a load: the square swells and breathes about the state that centrifugal force
asks for. A rate of stress without the terms of the spin takes the rotation itself for shear.
"""

from collections.abc import Iterator

import numpy as np

from sphstudy.model.lattice import lattice_sites, square
from sphstudy.model.problem import Body, Problem, Stage
from sphstudy.model.scenes.solid import SolidParameters, unconstrained
from sphstudy.parameters import number, parameters


@parameters
class SquareParameters(SolidParameters):
    """A square of `n` by `n` particles."""

    L: float = number("side of the square", "m", gt=0)


@parameters
class Parameters(SquareParameters):
    """The square and its rotation."""

    rate: float = number("angular velocity at the start", "rad/s", gt=0)
    turns: float = number("length of the run, in turns at that rate", gt=0)


def check(config) -> Iterator[str]:
    """Complaints about the resolution."""
    if config.n < 3:
        yield f"n={config.n}: must be at least 3 in {config.scene.name}"


def particles(config) -> int:
    """How many particles the scene has."""
    return config.n * config.n


def square_body(config) -> Body:
    """The particles of a square about the origin."""
    x, y, spacing = square(config.scene.L, config.n)
    sites = lattice_sites(config.n, config.n)
    return Body.of_squares(x, y, spacing, config.scene.material, sites=sites)


def build(config) -> Problem:
    """Problem of the spinning square; tracked: its upper right corner."""
    scene = config.scene
    body = square_body(config)
    return Problem(
        body=body,
        constraints=unconstrained(),
        stages=(Stage("run", "run", duration=scene.turns * 2.0 * np.pi / scene.rate),),
        step_spacing=body.spacing_x,
        energy_compliance=body.material.compliance,
        velocity_x=-scene.rate * body.y,
        velocity_y=scene.rate * body.x,
        tracked=body.x.size - 1,
    )
