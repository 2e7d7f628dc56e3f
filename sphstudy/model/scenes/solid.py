"""What every scene says of itself and of its material."""

from typing import Literal

from sphstudy.model.material import Material
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
