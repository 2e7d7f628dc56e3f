"""Disc pulled by its rim alike in all directions, then held: tension without any shear.

Rim particles are driven with u = strain · x, the displacement of the exact state, homogeneous
equibiaxial stress. Zhang, Wu & Hu (J. Comput. Phys. 2024) hold that what is called tensile instability in
solids is an hourglass mode of the shear. In this state there is no shear: whatever clumps here does so of
tension alone.
"""

from collections.abc import Iterator

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.lattice import centred, lattice, noise
from sphstudy.model.problem import Body, Problem
from sphstudy.model.scenes.solid import held
from sphstudy.model.scenes.tension import StretchedParameters, strain_complaint
from sphstudy.parameters import count, number, parameters


@parameters
class Parameters(StretchedParameters):
    """A disc cut from a square lattice with `n` particles along its diameter, centred at the origin."""

    radius: float = number("radius of the disc", "m", gt=0)
    rim_layers: int = count("width of the driven rim, in spacings", ge=1)


def check(config) -> Iterator[str]:
    """Complaints about resolution and strain."""
    yield from strain_complaint(config)
    least = 4 * (config.scene.rim_layers + 1)
    if config.n < least:
        yield f"n={config.n}: must be at least {least} in {config.scene.name} (for rim and middle half)"


def particles(config) -> int:
    """How many particles the scene has."""
    return int(np.count_nonzero(_inside(config)))


def _inside(config) -> np.ndarray:
    """Which sites of the square lattice [n, n] lie in the disc."""
    line = centred(config.n, 1.0)
    return line[:, None] ** 2 + line**2 < (0.5 * config.n) ** 2


def disc(config) -> Body:
    """The disc; tags: "driven" (rim), "middle": within half of the radius."""
    scene, n = config.scene, config.n
    spacing = 2.0 * scene.radius / n
    line, inside = centred(n, spacing), _inside(config)
    x, y = (axis[inside.ravel()] for axis in lattice(line, line))
    distance = np.hypot(x, y)
    tags = {
        "driven": distance > scene.radius - scene.rim_layers * spacing,
        "middle": distance < 0.5 * scene.radius,
    }
    off = noise(x.size, scene.noise * spacing, config.seed)
    sites = np.stack(np.nonzero(inside))[::-1]
    return Body.of_squares(x + off[0], y + off[1], spacing, scene.material, tags=tags, sites=sites)


def build(config) -> Problem:
    """Problem of the pulled disc: rim driven in x and y."""
    body, strain = disc(config), config.scene.strain
    rim = np.flatnonzero(body.tags["driven"])
    free = np.where(body.tags["driven"], 0.0, np.hypot(body.x, body.y))
    return held(
        config,
        body,
        Constraints(rim, strain * body.x[rim], rim, strain * body.y[rim]),
        tracked=int(np.argmax(free)),
    )
