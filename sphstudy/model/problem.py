"""The nouns of a scene: Body, Crack, Stages, together a Problem. Arrays and numbers only."""

from dataclasses import dataclass, field

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.material import Material


@dataclass(frozen=True)
class Body:
    """Particles in the reference configuration, stored row by row (x fastest); sums over pairs of
    particles stored in random order take several times as long.

    x, y [N] (m); mass [N] per thickness (kg/m); spacing_x, spacing_y (m); tags: named masks [N]. sites
    [2, N]: column and row of the lattice that each particle was put on, whatever moved it off since.
    part [N]: which of several bodies a particle belongs to; None: all to one.
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

    @property
    def mean_spacing(self) -> float:
        """(Δx + Δy)/2 [m], what the relative smoothing radius h̃ refers to."""
        return 0.5 * (self.spacing_x + self.spacing_y)

    @property
    def surface(self) -> np.ndarray:
        """Mask [N] of the particles beside a site, diagonals too, that is empty or another part's.

        Raises ValueError if the body has no sites.
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

    action "run": step freely for `duration` (s). "load": drive the constraints from amplitude 0 to 1.
    "settle": hold them, until time `until` (s) or, if None, for as long as the solver's protocol says.
    `crack_nodes`: how many of the crack's nodes are open.
    """

    name: str
    action: str
    duration: float | None = None
    until: float | None = None
    crack_nodes: int = 0
    extension: bool = False


@dataclass(frozen=True)
class Problem:
    """A scene at one resolution, ready to be discretised.

    velocity_x, velocity_y [N]: initial velocity (m/s). crack_first, crack_second [K]: the pairs of
    particles that carry the crack's nodes, those of later extensions included. step_spacing: the Δ of
    the time step rule (2.27) (m). energy_compliance: E* (Pa) and ν* by which strains follow from stresses
    in the strain energy (3.18). tracked: index of the particle whose displacement is recorded.
    displacement_x, displacement_y [N]: where particles start, from their places in the body (m); None: at
    those. mirrors: "x" and "y", the coordinates whose change of sign leaves the motion as it is.
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


def lattice(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions of all particles of the lattice with columns x and rows y, x fastest."""
    grid_y, grid_x = np.meshgrid(y, x, indexing="ij")
    return grid_x.ravel(), grid_y.ravel()


def lattice_sites(columns: int, rows: int) -> np.ndarray:
    """Column and row [2, columns · rows] of each particle of a lattice, in the order of `lattice`."""
    return np.stack([axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows))])


def at_site(sites: np.ndarray, column: np.ndarray, row: np.ndarray) -> np.ndarray:
    """Index of the particle at each of these columns and rows, -1 where there is none; sites [2, N]."""
    low = sites.min(axis=1) - 1
    height = sites[1].max() - low[1] + 2
    own = (sites[0] - low[0]) * height + sites[1] - low[1]
    wanted = (column - low[0]) * height + row - low[1]
    order = np.argsort(own)
    place = np.minimum(np.searchsorted(own[order], wanted), own.size - 1)
    return np.where(own[order][place] == wanted, order[place], -1)
