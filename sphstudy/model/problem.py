"""What is simulated: a Body, how its motion is prescribed, and Stages; together a Problem."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.lattice import at_site
from sphstudy.model.material import Material


@dataclass(frozen=True)
class Body:
    """Particles in the reference configuration, stored row by row (x fastest): in random order, sums over
    pairs take several times as long.

    Attributes
    ----------
    x, y : array [N]
        Positions (m).
    mass : array [N]
        Mass per thickness (kg/m).
    spacing_x, spacing_y : float
        Of the lattice (m).
    material : Material
        Of all particles.
    tags : dict of str to array [N]
        Masks with names.
    sites : array [2, N], optional
        Column and row of the lattice that each particle was put on, whatever moved it off since.
    part : array [N], optional
        Which of several bodies a particle belongs to; without it, all belong to one.
    """

    x: np.ndarray
    y: np.ndarray
    mass: np.ndarray
    spacing_x: float
    spacing_y: float
    material: Material
    tags: dict[str, np.ndarray] = field(default_factory=dict)
    sites: np.ndarray | None = None
    part: np.ndarray | None = None

    @classmethod
    def of_squares(
        cls, x: np.ndarray, y: np.ndarray, spacing: float, material: Material, **rest: Any
    ) -> "Body":
        """A body whose particles stand for square cells.

        Parameters
        ----------
        x, y : array [N]
            Positions (m).
        spacing : float
            Side of a cell (m).
        material : Material
            Of all particles.
        **rest
            `tags`, `sites` and `part`.
        """
        return cls(
            x, y, np.full(x.size, material.density * spacing**2), spacing, spacing, material, **rest
        )

    @property
    def mean_spacing(self) -> float:
        """(Δx + Δy)/2 [m], what the relative smoothing radius h̃ refers to."""
        return 0.5 * (self.spacing_x + self.spacing_y)

    @property
    def surface(self) -> np.ndarray:
        """Mask [N] of the particles next to an empty site, diagonals too, or to another part's.

        Raises
        ------
        ValueError
            If the body has no sites.
        """
        if self.sites is None:
            raise ValueError("a body without a lattice does not know its surface")
        column, row = self.sites
        steps = [(dc, dr) for dc in (-1, 0, 1) for dr in (-1, 0, 1) if dc or dr]
        around = np.stack([at_site(self.sites, column + dc, row + dr) for dc, dr in steps])
        inside = (around >= 0).all(axis=0)
        if self.part is not None:
            inside &= (self.part[around] == self.part).all(axis=0)
        return np.logical_not(inside)


@dataclass(frozen=True)
class Stage:
    """One part of a run.

    Attributes
    ----------
    name : str
        Label of the fields that are kept at its end.
    action : {"run", "load", "settle"}
        Steps freely; drives the constraints from amplitude 0 to 1; holds them.
    duration : float, optional
        Of a run (s).
    until : float, optional
        Time at which settling ends (s); without it, the solver's settings say how long it takes.
    crack_nodes : int
        Nodes of the crack that are open.
    extension : bool
        Whether the crack has been extended for it.
    """

    name: str
    action: str
    duration: float | None = None
    until: float | None = None
    crack_nodes: int = 0
    extension: bool = False


@dataclass(frozen=True, eq=False)
class Problem:
    """A scene at one resolution, ready to be discretised.

    Attributes
    ----------
    body : Body
        The particles.
    constraints : Constraints
        What is held or driven.
    stages : tuple of Stage
        In their order.
    step_spacing : float
        The Δ of the time step rule (2.27) (m).
    energy_compliance : tuple of float
        E* (Pa) and ν* by which strains follow from stresses in the strain energy (3.18).
    velocity_x, velocity_y : array [N]
        Initial velocity (m/s).
    tracked : int
        Index of the particle whose displacement is recorded.
    crack_first, crack_second : array [K]
        Pairs of particles that carry the crack's nodes, those of later extensions included.
    displacement_x, displacement_y : array [N], optional
        From the places in the body to where particles start (m).
    mirrors : tuple of {"x", "y"}
        Coordinates whose change of sign leaves the motion as it is.
    """

    body: Body
    constraints: Constraints
    stages: tuple[Stage, ...]
    step_spacing: float
    energy_compliance: tuple[float, float]
    velocity_x: np.ndarray
    velocity_y: np.ndarray
    tracked: int
    crack_first: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    crack_second: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    displacement_x: np.ndarray | None = None
    displacement_y: np.ndarray | None = None
    mirrors: tuple[str, ...] = ()

    @property
    def start(self) -> np.ndarray:
        """Positions at the beginning [2, N] (m)."""
        place = np.stack((self.body.x, self.body.y))
        for row, moved in enumerate((self.displacement_x, self.displacement_y)):
            if moved is not None:
                place[row] += moved
        return place
