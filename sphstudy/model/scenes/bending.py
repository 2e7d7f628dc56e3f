"""Plate bent by a prescribed deflection of its end, then held until it is at rest (thesis 3.2)."""

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.problem import Problem, Stage
from sphstudy.model.scenes.plate import PlateParameters, check, end_particle, particles, plate_body
from sphstudy.parameters import number, parameters

__all__ = ["Parameters", "build", "check", "particles"]


@parameters
class Parameters(PlateParameters):
    """The plate, the deflection of its end, and when it is looked at."""

    deflection: float = number("u_y of the last column, in units of L", gt=-0.5, lt=0.5)
    end_time: float = number("time at which the state is measured", "s", gt=0)


def build(config) -> Problem:
    """Problem of the bending plate: last column free in x, driven in y (3.4)."""
    scene = config.scene
    body = plate_body(config)
    clamped = np.flatnonzero(body.tags["clamped"])
    driven = np.flatnonzero(body.tags["end"])
    still = np.zeros(clamped.size)
    return Problem(
        body=body,
        constraints=Constraints(
            x_index=clamped,
            x_target=still,
            y_index=np.concatenate((clamped, driven)),
            y_target=np.concatenate((still, np.full(driven.size, scene.deflection * scene.L))),
        ),
        stages=(Stage("load", "load"), Stage("settle", "settle", until=scene.end_time)),
        step_spacing=body.spacing_y,
        energy_compliance=body.material.compliance,
        velocity_x=np.zeros(body.x.size),
        velocity_y=np.zeros(body.x.size),
        tracked=end_particle(body),
    )
