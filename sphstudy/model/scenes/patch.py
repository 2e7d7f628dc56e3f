"""Patch test (Irons 1966) on disordered particles: what is affine on the frame must be affine inside.

Particles carry equal volumes, however they lie: that they do not tile the square is part of the case.
"""

from collections.abc import Iterator

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.lattice import lattice_sites, noise, square
from sphstudy.model.problem import Body, Problem
from sphstudy.model.scenes.solid import SolidParameters, held
from sphstudy.parameters import count, number, parameters


@parameters
class Parameters(SolidParameters):
    """A square of `n` by `n` particles about the origin, and the affine displacement of its frame."""

    L: float = number("side of the square", "m", gt=0)
    perturbation: float = number("largest displacement from the lattice, in spacings", ge=0, le=0.4)
    frame_layers: int = count("layers of particles, from the edge inwards, that are driven", ge=1)
    gradient_xx: float = number("∂u_x/∂x of the frame", gt=-0.5, lt=0.5)
    gradient_xy: float = number("∂u_x/∂y of the frame", gt=-0.5, lt=0.5)
    gradient_yx: float = number("∂u_y/∂x of the frame", gt=-0.5, lt=0.5)
    gradient_yy: float = number("∂u_y/∂y of the frame", gt=-0.5, lt=0.5)
    end_time: float = number("time at which the state is measured", "s", gt=0)

    @property
    def gradient(self) -> np.ndarray:
        """Displacement gradient [2, 2] of the frame: ∂u_a/∂x_b in row a, column b."""
        return np.array([[self.gradient_xx, self.gradient_xy], [self.gradient_yx, self.gradient_yy]])


def check(config) -> Iterator[str]:
    """Complaints about the resolution, and about a frame that does not move."""
    scene = config.scene
    least = 2 * scene.frame_layers + 2
    if config.n < least:
        yield f"n={config.n}: must be at least {least} in {scene.name} (for frame and inside)"
    if not scene.gradient.any():
        yield f"scene.gradient_xx=0: {scene.name} needs a frame that moves, all four are zero"


def particles(config) -> int:
    """How many particles the scene has."""
    return config.n * config.n


def body(config) -> Body:
    """The square, all of its particles off the lattice; tag "frame": driven."""
    scene, n = config.scene, config.n
    x, y, spacing = square(scene.L, n)
    tags = {"frame": np.maximum(np.abs(x), np.abs(y)) > 0.5 * scene.L - scene.frame_layers * spacing}
    off = noise(x.size, scene.perturbation * spacing, config.seed)
    sites = lattice_sites(n, n)
    return Body.of_squares(x + off[0], y + off[1], spacing, scene.material, tags=tags, sites=sites)


def build(config) -> Problem:
    """Problem of the patch test: frame driven with the affine displacement of its particles."""
    square = body(config)
    frame = np.flatnonzero(square.tags["frame"])
    u_x, u_y = config.scene.gradient @ np.stack((square.x, square.y))[:, frame]
    distance = np.where(square.tags["frame"], np.inf, np.hypot(square.x, square.y))
    return held(config, square, Constraints(frame, u_x, frame, u_y), tracked=int(np.argmin(distance)))
