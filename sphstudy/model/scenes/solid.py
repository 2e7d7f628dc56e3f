"""What scenes share: parameters of the solid, nothing held, a load that is held."""

from typing import Literal

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.material import Material
from sphstudy.model.problem import Body, Problem, Stage
from sphstudy.parameters import described, number, parameters


@parameters
class SolidParameters:
    """Name, builder, and an isotropic elastic solid."""

    name: str = described("name of the scene")
    kind: str = described("module that builds it")
    E: float = number("Young's modulus", "Pa", gt=0)
    nu: float = number("Poisson's ratio", gt=-1, lt=0.5)
    rho: float = number("density", "kg/m3", gt=0)
    plane: Literal["strain", "stress"] = described("plane strain or plane stress")

    @property
    def material(self) -> Material:
        """The solid as Young's modulus, Poisson's ratio, density and plane."""
        return Material(self.E, self.nu, self.rho, self.plane)


def unconstrained() -> Constraints:
    """Nothing held, nothing driven."""
    nobody, nowhere = np.empty(0, np.int64), np.empty(0)
    return Constraints(nobody, nowhere, nobody, nowhere)


def held(config, body: Body, constraints: Constraints, tracked: int) -> Problem:
    """A body at rest that is loaded, then held until the scene's end time.

    Parameters
    ----------
    config : RunConfig
        The run; its scene has an `end_time`.
    body, constraints, tracked
        As in Problem.
    """
    still = np.zeros(body.x.size)
    return Problem(
        body=body,
        constraints=constraints,
        stages=(Stage("load", "load"), Stage("settle", "settle", until=config.scene.end_time)),
        step_spacing=body.mean_spacing,
        energy_compliance=body.material.compliance,
        velocity_x=still,
        velocity_y=still,
        tracked=tracked,
    )
