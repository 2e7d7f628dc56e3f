"""Vibrating plate of Gray, Monaghan & Swift (2001), clamped rigidly or by an insert.

Comput. Methods Appl. Mech. Eng. 190, 6641. With an insert the plate goes on into the wall, where its
outermost rows are held.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from sphstudy.model.exact import beam
from sphstudy.model.problem import Body, Problem
from sphstudy.model.scenes.plate import SlabParameters, slab, vibrating
from sphstudy.parameters import described, number, parameters


@parameters
class Parameters(SlabParameters):
    """A plate with `n` rows (of either parity), how it is clamped, and its first push."""

    clamp: Literal["rigid", "insert"] = described(
        "one column held at x = 0, or the faces of an insert held for x < 0",
    )
    insert_length: float = number(
        "length of the insert, in heights; of the clamp of that name", gt=0, le=4
    )
    tip_speed: float = number("initial speed at x = L, in units of c0 = √(K/ρ)", gt=0, lt=1)
    periods: float = number("length of the run, in periods of the thin plate", gt=0)

    def insert_columns(self, n: int) -> int:
        """Columns of particles in the insert; none with a rigid clamp."""
        return max(1, round(self.insert_length * n)) if self.clamp == "insert" else 0

    def held_length(self, n: int) -> float:
        """The insert's, in whole columns of particles (m); 0 with a rigid clamp."""
        return self.insert_columns(n) * self.L / (self.slenderness * n)

    @property
    def push(self) -> float:
        """Speed (m/s) at x = L at the start."""
        return self.tip_speed * self.material.wave_speed


def check(config) -> Iterator[str]:
    """Complaints about the resolution."""
    if config.n < 3:
        yield f"n={config.n}: must be at least 3 in {config.scene.name}"


def particles(config) -> int:
    """How many particles the scene has."""
    scene = config.scene
    return (scene.slenderness * config.n + scene.insert_columns(config.n)) * config.n


def body(config) -> Body:
    """The particles, rows at odd multiples of Δ/2 if their number is even; tag "clamped": held ones.

    Both clamps make a body that ends at x = L. Rigid: a column at x = 0, so that Δx is 1/(2 s n) wider
    than Δy, s the slenderness. Insert: a square lattice that x = 0 cuts half-way between two columns.
    """
    scene, rows = config.scene, config.n
    columns = scene.slenderness * rows
    spacing = scene.L / columns
    if scene.clamp == "rigid":
        wider = scene.L / (columns - 0.5)
        return slab(wider * np.arange(columns), rows, wider, spacing, scene.material)
    along = spacing * (np.arange(-scene.insert_columns(config.n), columns) + 0.5)
    whole = slab(along, rows, spacing, spacing, scene.material)
    outermost = np.isin(whole.sites[1], (0, rows - 1))  # type: ignore[index]
    return replace(whole, tags=whole.tags | {"clamped": (whole.x < 0.0) & outermost})


def build(config) -> Problem:
    """Problem of the plate: clamp, initial velocity of a beam's lowest mode, one free stage."""
    scene, plate = config.scene, body(config)
    omega = beam.thin_plate_frequency(scene.E, scene.nu, scene.rho, scene.L, scene.height)
    velocity = beam.mode_shape(plate.x, scene.L) * scene.push
    return vibrating(plate, velocity, scene.periods * 2.0 * np.pi / omega)
