"""Square driven, particle by particle, into a checkerboard: u_x = ±a, alternating along rows and columns.

This is the shortest wave that a lattice carries, and centred sums over neighbours do not see it: which
force brings the particles back? All of them are driven, slowly: the power of the constraints is then that
of the restoring forces, and nothing can run away. The pattern fades out towards the surface, where
neighbours are missing and the forces would be those of another lattice.
"""

from collections.abc import Iterator

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.problem import Problem, Stage
from sphstudy.model.scenes import spin
from sphstudy.model.scenes.spin import SquareParameters, particles, square_body
from sphstudy.parameters import number, parameters

__all__ = ["Parameters", "build", "check", "particles", "pattern"]


@parameters
class Parameters(SquareParameters):
    """The square and the checkerboard."""

    amplitude: float = number("largest displacement, in spacings", gt=0, lt=0.25)

    def displacements(self, n: int) -> np.ndarray:
        """u_x [n · n] (m) of the checkerboard with all of its load."""
        return self.amplitude * (self.L / n) * pattern(n)


def check(config) -> Iterator[str]:
    """Complaints about resolution and solver."""
    yield from spin.check(config)
    if config.solve.name != "explicit":
        yield f"solve={config.solve.name}: {config.scene.name} leaves no particle free; take explicit"


def pattern(n: int) -> np.ndarray:
    """The checkerboard [n · n], ±1 in the middle of the square, faded as sin² towards its surface."""
    fading = np.sin(np.pi * (np.arange(n) + 0.5) / n) ** 2
    signs = 1.0 - 2.0 * (np.arange(n) % 2)
    line = signs * fading
    return np.outer(line, line).ravel()


def build(config) -> Problem:
    """Problem of the checkerboard: every particle is driven in x and held in y."""
    body = square_body(config)
    everybody = np.arange(body.x.size)
    target = config.scene.displacements(config.n)
    return Problem(
        body=body,
        constraints=Constraints(everybody, target, everybody, np.zeros(body.x.size)),
        stages=(Stage("load", "load"),),
        step_spacing=body.spacing_x,
        energy_compliance=body.material.compliance,
        velocity_x=np.zeros(body.x.size),
        velocity_y=np.zeros(body.x.size),
        tracked=body.x.size // 2 + (0 if config.n % 2 else config.n // 2),
    )
