"""Vibrating plate, clamped at x = 0, free elsewhere (thesis 3.1): one period of its lowest mode."""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.exact import beam
from sphstudy.model.lattice import centred, lattice, lattice_sites
from sphstudy.model.material import Material
from sphstudy.model.problem import Body, Problem, Stage
from sphstudy.model.scenes.solid import SolidParameters
from sphstudy.parameters import count, described, number, parameters


@parameters
class SlabParameters(SolidParameters):
    """The elastic body: a plate of length L beyond its clamp, `n` rows high."""

    L: float = number("length", "m", gt=0)
    slenderness: int = count("length over height; columns per row", ge=2)

    @property
    def height(self) -> float:
        """Full height (m)."""
        return self.L / self.slenderness

    def represented_length(self, n: int) -> float:
        """Length (m) of the body that particles in n rows stand for, from the wall to the free end."""
        return self.L

    def held_length(self, n: int) -> float:
        """Length (m) of the part behind the wall whose faces are held."""
        return 0.0

    @property
    def push(self) -> float | None:
        """Speed (m/s) of the tip at the start, where the scene prescribes it."""
        return None


@parameters
class PlateParameters(SlabParameters):
    """A plate clamped by columns of particles: slenderness·n columns from x = 0 on."""

    columns: Literal["linspace", "spacing"] = described(
        "columns from 0 to L - Δx/2 evenly (Δx = L/(12n - 1/2)), or at kΔy, half a cell short of L",
    )
    clamped_columns: int = count("columns of particles held at the wall, the last at x = 0", ge=1, le=8)

    def represented_length(self, n: int) -> float:
        """To half a cell beyond the last column (m)."""
        if self.columns == "linspace":
            return self.L
        return self.L - 0.5 * self.L / (self.slenderness * n)


@parameters
class Parameters(PlateParameters):
    """The plate and its first push."""

    H0: float = number("amplitude of the tip, in units of L", gt=0, lt=1)
    periods: float = number("length of the run, in periods of the Euler-Bernoulli beam", gt=0)


def check(config) -> Iterator[str]:
    """Complaints about the resolution."""
    scene = config.scene.name
    if config.n % 2 == 0:
        yield f"n={config.n}: must be odd in {scene} (tracked particle and centreline sit at y = 0)"
    if config.n < 3:
        yield f"n={config.n}: must be at least 3 in {scene}"


def particles(config) -> int:
    """How many particles the scene has."""
    return config.scene.slenderness * config.n * config.n


def plate_body(config) -> Body:
    """The particles of the plate; tags: "clamped" at x ≤ 0, "centreline" at y = 0, "end": last column."""
    scene, rows = config.scene, config.n
    spacing_y = scene.height / rows
    columns = scene.slenderness * rows
    spacing_x = scene.L / (columns - 0.5) if scene.columns == "linspace" else spacing_y
    x = spacing_x * np.arange(1 - scene.clamped_columns, columns)
    return slab(x, rows, spacing_x, spacing_y, scene.material)


def slab(x: np.ndarray, rows: int, spacing_x: float, spacing_y: float, material: Material) -> Body:
    """A rectangular lattice, its rows about y = 0, with the tags of `plate_body`.

    Parameters
    ----------
    x : array [columns]
        Coordinates of the columns (m).
    rows : int
        Number of rows; if it is even, no particle lies on the centreline.
    spacing_x, spacing_y : float
        Of columns and rows (m).
    material : Material
        Of all particles.
    """
    grid_x, grid_y = lattice(x, centred(rows, spacing_y))
    tags = {"clamped": grid_x <= 0.0, "centreline": grid_y == 0.0, "end": grid_x == x[-1]}
    mass = np.full(grid_x.size, material.density * spacing_x * spacing_y)
    sites = lattice_sites(x.size, rows)
    return Body(grid_x, grid_y, mass, spacing_x, spacing_y, material, tags, sites)


def end_particle(body: Body) -> int:
    """Index of the particle of the last column closest to the mid-line; the lower one of two."""
    end = np.flatnonzero(body.tags["end"])
    return int(end[np.argmin(np.abs(body.y[end]))])


def build(config) -> Problem:
    """Problem of the vibrating plate: clamp, initial velocity (3.2), one free stage."""
    scene = config.scene
    omega = beam.fundamental_frequency(scene.E, scene.rho, scene.L, scene.height)
    body = plate_body(config)
    velocity = beam.mode_shape(body.x, scene.L) * scene.H0 * scene.L * omega
    return vibrating(body, velocity, scene.periods * 2.0 * np.pi / omega)


def vibrating(body: Body, velocity: np.ndarray, duration: float) -> Problem:
    """A plate that is pushed once and then vibrates.

    Parameters
    ----------
    body : Body
        The plate, held where it is tagged "clamped".
    velocity : array [N]
        Initial v_y (m/s) of the particles at x > 0; all others begin at rest.
    duration : float
        Of the run (s).
    """
    clamped = np.flatnonzero(body.tags["clamped"])
    still = np.zeros(clamped.size)
    return Problem(
        body=body,
        constraints=Constraints(clamped, still, clamped, still),
        stages=(Stage("vibrate", "run", duration=duration),),
        step_spacing=body.spacing_y,
        energy_compliance=body.material.compliance,
        velocity_x=np.zeros(body.x.size),
        velocity_y=np.where(body.x > 0.0, velocity, 0.0),
        tracked=end_particle(body),
    )
