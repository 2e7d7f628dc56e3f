"""Contact between bodies, and of a body with itself: a repulsion between surface particles.

The potential φ(r) = κ (λ + 2µ) d0² (1 - r/d0)³ for r < d0 makes a central force,

    f(r) = 3 κ (λ + 2µ) d0 (1 - r/d0)²   per thickness,

so that contact keeps momentum, angular momentum and energy, and its stiffness is continuous. With a
range d0 of less than two spacings, the rows of two lattices that face each other are in unstable
equilibrium and slip past each other. No friction, no adhesion.
"""

from typing import NamedTuple

import numpy as np

from sphstudy.numerics.compilation import compiled
from sphstudy.numerics.sph import neighbours

SKIN = 0.4
"""Of the range: how much farther apart pairs are kept in the list."""

APART = 2.0
"""Particles of one body that stood closer than so many ranges belong together, they do not touch."""


class Contact(NamedTuple):
    """strength: κ (λ + 2µ) (Pa); reach: d0 (m); the pairs that may touch, ordered by (first, second); how
    long they are good, as in Neighbours: skin (m), and positions built_x, built_y [N] (m).
    """

    strength: float
    reach: float
    first: np.ndarray
    second: np.ndarray
    skin: float
    built_x: np.ndarray
    built_y: np.ndarray


class Surfaces(NamedTuple):
    """What can touch: strength (Pa) and reach (m) as in Contact; particles [S] at surfaces; all reference
    positions x, y [N] (m); and the body that each particle belongs to [N], if there are several.
    """

    strength: float
    reach: float
    particles: np.ndarray
    x: np.ndarray
    y: np.ndarray
    part: np.ndarray | None

    def contact(self, x: np.ndarray, y: np.ndarray) -> Contact:
        """The pairs that may touch before any particle has moved half the skin from x, y [N] (m).

        In an order that does not depend on when they were looked for: pairs out of reach add nothing, so
        that the sum of forces has the same bits whenever the list was made.
        """
        skin = SKIN * self.reach
        first, second = neighbours.close_pairs(x[self.particles], y[self.particles], self.reach + skin)
        order = np.lexsort((second, first))
        first, second = self.particles[first[order]], self.particles[second[order]]
        apart = np.hypot(self.x[second] - self.x[first], self.y[second] - self.y[first])
        strangers = apart > APART * self.reach
        if self.part is not None:
            strangers |= self.part[first] != self.part[second]
        first, second = first[strangers], second[strangers]
        return Contact(self.strength, self.reach, first, second, skin, x.copy(), y.copy())


@compiled
def add_forces(contact, x, y, force):
    """Adds the forces of contact [2, N] (N/m) at the positions x, y [N] (m), unless `contact` is None."""
    if contact is None:
        return
    for p in range(contact.first.size):
        i, j = contact.first[p], contact.second[p]
        dx, dy = x[j] - x[i], y[j] - y[i]
        distance = np.sqrt(dx * dx + dy * dy)
        close = max(1.0 - distance / contact.reach, 0.0)
        push = 3.0 * contact.strength * contact.reach * close * close / max(distance, 1e-300)
        force[0, i] -= push * dx
        force[1, i] -= push * dy
        force[0, j] += push * dx
        force[1, j] += push * dy


@compiled
def energy(contact, x, y):
    """Σ φ [J/m] at the positions x, y [N] (m); 0 if `contact` is None."""
    if contact is None:
        return 0.0
    total = 0.0
    for p in range(contact.first.size):
        i, j = contact.first[p], contact.second[p]
        distance = np.hypot(x[j] - x[i], y[j] - y[i])
        total += max(1.0 - distance / contact.reach, 0.0) ** 3
    return contact.strength * contact.reach**2 * total
