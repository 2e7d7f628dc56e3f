"""Bar pulled in x by both ends, free in y, then held: an exact state that a sound method keeps for ever.

The end columns are driven with the affine displacement u_x = strain · x of the exact state, homogeneous
uniaxial stress. What grows out of the seeded noise in the particles' places is the method's own.
"""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.lattice import centred, lattice, lattice_sites, noise
from sphstudy.model.problem import Body, Problem
from sphstudy.model.scenes.solid import SolidParameters, held
from sphstudy.parameters import count, described, number, parameters


@parameters
class StretchedParameters(SolidParameters):
    """A body of noisy lattice that is brought to a homogeneous state of stress and held there."""

    plane: Literal["strain"] = described("plane strain: the exact states are written for it")
    strain: float = number("prescribed elongation over length; not zero", gt=-0.5, le=1)
    noise: float = number("largest displacement from the lattice, in spacings", ge=0, le=0.05)
    end_time: float = number("time at which the held state is measured", "s", gt=0)


@parameters
class Parameters(StretchedParameters):
    """A bar of `n` rows (odd: the axis carries particles), centred at the origin."""

    length: float = number("length of the bar, rounded to whole columns", "m", gt=0)
    height: float = number("height of the bar", "m", gt=0)
    driven_columns: int = count("columns of particles driven at either end", ge=1, le=8)


def check(config) -> Iterator[str]:
    """Complaints about resolution and strain."""
    yield from strain_complaint(config)
    if config.n % 2 == 0:
        yield f"n={config.n}: must be odd in {config.scene.name} (the axis carries particles)"
    free = columns(config) - 2 * config.scene.driven_columns
    if free < 4:
        yield f"n={config.n}: leaves {free} free columns in {config.scene.name}, at least 4 are needed"


def strain_complaint(config) -> Iterator[str]:
    """A complaint if nothing is stretched: metrics compare stresses with the exact ones."""
    if config.scene.strain == 0.0:
        yield f"scene.strain=0: must not be zero in {config.scene.name}"


def columns(config) -> int:
    """Columns of square cells along the bar."""
    return round(config.scene.length / config.scene.height * config.n)


def particles(config) -> int:
    """How many particles the scene has."""
    return config.n * columns(config)


def bar(config) -> Body:
    """The bar; tags: "driven" in x, "section" (half of the length), "middle" (of that, half of the
    height), "pins" (held in y: the axis at either end).
    """
    scene, rows, across = config.scene, config.n, columns(config)
    spacing = scene.height / rows
    x, y = lattice(centred(across, spacing), centred(rows, spacing))
    sites = lattice_sites(across, rows)
    from_end = np.minimum(sites[0], across - 1 - sites[0])
    tags = {
        "driven": from_end < scene.driven_columns,
        "section": np.abs(x) < 0.25 * across * spacing,
        "middle": (np.abs(x) < 0.25 * across * spacing) & (np.abs(y) < 0.25 * scene.height),
        "pins": (from_end == 0) & (sites[1] == rows // 2),
    }
    off = noise(x.size, scene.noise * spacing, config.seed)
    return Body.of_squares(x + off[0], y + off[1], spacing, scene.material, tags=tags, sites=sites)


def build(config) -> Problem:
    """Problem of the pulled bar: ends driven in x, the bar kept from drifting in y by two particles."""
    body = bar(config)
    driven, pins = (np.flatnonzero(body.tags[name]) for name in ("driven", "pins"))
    return held(
        config,
        body,
        Constraints(driven, config.scene.strain * body.x[driven], pins, np.zeros(pins.size)),
        # Middle of the upper face, whose u_y is the contraction.
        tracked=(config.n - 1) * columns(config) + columns(config) // 2,
    )
