"""Two rubber rings that fly against each other, collide and rebound (Swegle 1992; Gray, Monaghan & Swift
2001): the standard trial for numerical fracture in tension.
"""

import math
from collections.abc import Iterator
from typing import Literal

import numpy as np

from sphstudy.model.problem import Body, Problem, Stage
from sphstudy.model.scenes.solid import SolidParameters, unconstrained
from sphstudy.parameters import count, described, number, parameters


@parameters
class Parameters(SolidParameters):
    """Two rings of `n` particles across their wall, cut from one square lattice."""

    plane: Literal["strain"] = described("plane strain")
    inner: float = number("inner radius", "m", gt=0)
    outer: float = number("outer radius", "m", gt=0)
    speed: float = number("of each ring towards the other, in units of c0 = √(K/ρ)", gt=0, lt=0.5)
    gap: int = count("between the rings at the beginning, in particle spacings", ge=4)
    duration: float = number("of the run, in units of outer diameter / c0", gt=0)


def check(config) -> Iterator[str]:
    """Complaints about the resolution and the radii."""
    scene = config.scene
    if config.n < 4:
        yield f"n={config.n}: must be at least 4 in {scene.name} (particles across the wall)"
    if scene.inner >= scene.outer:
        yield f"scene.inner={scene.inner:g}: must be less than scene.outer={scene.outer:g}"


def particles(config) -> int:
    """About how many particles the scene has."""
    scene = config.scene
    spacing = (scene.outer - scene.inner) / config.n
    return round(2.0 * math.pi * (scene.outer**2 - scene.inner**2) / spacing**2)


def rings_body(config) -> Body:
    """The rings, mirror images of each other in x and each in y; tag "left": the one at x < 0."""
    scene = config.scene
    spacing = (scene.outer - scene.inner) / config.n
    # A whole number of sites from the middle to a centre: both rings share one lattice.
    shift = math.ceil(scene.outer / spacing) + math.ceil(0.5 * scene.gap)
    reach = shift + math.ceil(scene.outer / spacing)
    row, column = (
        grid.ravel()
        for grid in np.meshgrid(np.arange(-reach, reach), np.arange(-reach, reach), indexing="ij")
    )
    x, y = spacing * (column + 0.5), spacing * (row + 0.5)
    radius = np.hypot(np.abs(x) - shift * spacing, y)
    chosen = (radius > scene.inner) & (radius < scene.outer)
    x, y = x[chosen], y[chosen]
    left = x < 0.0
    return Body.of_squares(
        x,
        y,
        spacing,
        scene.material,
        tags={"left": left},
        sites=np.stack((column[chosen], row[chosen])),
        part=np.where(left, 0, 1),
    )


def build(config) -> Problem:
    """Problem of the rings: they fly freely, in one stage."""
    scene = config.scene
    body = rings_body(config)
    speed = scene.speed * body.material.wave_speed
    duration = scene.duration * 2.0 * scene.outer / body.material.wave_speed
    return Problem(
        body=body,
        constraints=unconstrained(),
        stages=(Stage("collide", "run", duration=duration),),
        step_spacing=body.spacing_x,
        energy_compliance=body.material.compliance,
        velocity_x=np.where(body.tags["left"], speed, -speed),
        velocity_y=np.zeros(body.x.size),
        tracked=int(np.argmin(body.x)),
        mirrors=("x", "y"),
    )
