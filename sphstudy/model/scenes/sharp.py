"""What no lattice resolves: a load put on in no time, and a single particle out of its place.

"wave": a bar flies lengthwise and its end is stopped. A compressive front runs into it, and everything
shorter than a few spacings stays behind the front as noise. "particle": the middle particle of a square
held by its frame starts displaced, at rest. What it has must spread over the square; nothing brings it
back where the stress is integrated from rates, which know no displacement.
"""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.exact.waves import longitudinal_speed
from sphstudy.model.lattice import centred, lattice, lattice_sites, square
from sphstudy.model.problem import Body, Problem, Stage
from sphstudy.model.scenes.solid import SolidParameters
from sphstudy.parameters import count, described, number, parameters


@parameters
class Parameters(SolidParameters):
    """A bar of `n` rows and slenderness·n columns, and what disturbs it."""

    shock: Literal["wave", "particle"] = described("a step load, or a particle out of place")
    L: float = number("length", "m", gt=0)
    slenderness: int = count("length over height; columns per row", ge=1)
    held_layers: int = count(
        "wave: columns held at x ≤ 0; particle: layers of the frame held", ge=1, le=8
    )
    strength: float = number("wave: speed over that of sound; particle: offset in spacings", gt=0, lt=0.5)
    crossings: float = number("length of the run, in times that a longitudinal wave takes for L", gt=0)


def check(config) -> Iterator[str]:
    """Complaints about resolution and setting."""
    scene, n = config.scene, config.n
    if n % 2 == 0:
        yield f"n={n}: must be odd in {scene.name} (the tracked particle sits at y = 0)"
    if scene.shock == "particle" and scene.slenderness != 1:
        yield f"scene.slenderness={scene.slenderness}: {scene.name} is a square, 1"
    if scene.shock == "particle" and n < 2 * scene.held_layers + 3:
        yield f"n={n}: must be at least {2 * scene.held_layers + 3} in {scene.name} (for its frame)"
    if scene.shock == "wave" and not scene.crossings < 1.0:
        yield f"scene.crossings={scene.crossings:g}: below 1 in {scene.name}, for the front to be inside"


def particles(config) -> int:
    """How many particles the scene has."""
    scene = config.scene
    extra = scene.held_layers - 1 if scene.shock == "wave" else 0
    return config.n * (config.n * scene.slenderness + extra)


def _wave_body(config) -> Body:
    """The bar: columns at whole spacings from the wall, the last of those held at x = 0."""
    scene, rows = config.scene, config.n
    columns = scene.slenderness * rows
    spacing = scene.L / columns
    x = spacing * np.arange(1 - scene.held_layers, columns)
    grid_x, grid_y = lattice(x, centred(rows, spacing))
    tags, sites = {"held": grid_x <= 0.0}, lattice_sites(x.size, rows)
    return Body.of_squares(grid_x, grid_y, spacing, scene.material, tags=tags, sites=sites)


def _particle_body(config) -> Body:
    """The square about the origin."""
    n, layers = config.n, config.scene.held_layers
    x, y, spacing = square(config.scene.L, n)
    sites = lattice_sites(n, n)
    inside = ((sites >= layers) & (sites < n - layers)).all(axis=0)
    return Body.of_squares(x, y, spacing, config.scene.material, tags={"held": ~inside}, sites=sites)


def build(config) -> Problem:
    """Problem of the stopped bar (strain in x only: all particles are held in y), or of the displaced
    particle.
    """
    scene, wave = config.scene, config.scene.shock == "wave"
    body = _wave_body(config) if wave else _particle_body(config)
    everybody, held = np.arange(body.x.size), np.flatnonzero(body.tags["held"])
    held_y = everybody if wave else held
    sound = longitudinal_speed(body.material)
    velocity = np.where(body.tags["held"], 0.0, -scene.strength * sound if wave else 0.0)
    middle = int(np.argmin(np.hypot(body.x - (0.5 * scene.L if wave else 0.0), body.y)))
    offset = np.zeros(body.x.size)
    offset[middle] = 0.0 if wave else scene.strength * body.spacing_x
    return Problem(
        body=body,
        constraints=Constraints(held, np.zeros(held.size), held_y, np.zeros(held_y.size)),
        stages=(Stage("run", "run", duration=scene.crossings * scene.L / sound),),
        step_spacing=body.spacing_x,
        energy_compliance=body.material.compliance,
        velocity_x=velocity,
        velocity_y=np.zeros(body.x.size),
        tracked=middle,
        displacement_x=None if wave else offset,
        mirrors=("y",),
    )
