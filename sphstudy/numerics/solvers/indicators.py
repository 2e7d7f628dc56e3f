"""Signs of a discretisation going bad that positions alone show: checkerboards and lost symmetry."""

from typing import NamedTuple

import numpy as np

from sphstudy.model.lattice import at_site
from sphstudy.model.problem import Body, Problem

_SIGNS = np.array((1.0, -1.0, -1.0, 1.0))
"""Of the checkerboard on a cell whose corners are (0, 0), (1, 0), (0, 1), (1, 1)."""


class Seen(NamedTuple):
    """hourglass_share: of the squared deformation of all lattice cells, what is checkerboard, 0 to 1.

    hourglass_amplitude: root mean square of the checkerboard, over the spacing; unlike the share it says
    nothing where a body is next to undeformed. mirror_defect: largest distance between a particle and its
    partner's image, over the spacing. NaN where a problem has no lattice, or no mirror.
    """

    hourglass_share: float
    hourglass_amplitude: float
    mirror_defect: float


class Indicators:
    """Looks at states of a problem. Raises ValueError if its lattice lacks a mirror that it names."""

    def __init__(self, problem: Problem):
        body = problem.body
        self._body = body
        self._cells = cells(body)
        self._partners = {axis: partners(body, axis) for axis in problem.mirrors}

    def measure(self, place: np.ndarray) -> Seen:
        """Of the positions [2, N] (m)."""
        moved = place - np.stack((self._body.x, self._body.y))
        return Seen(*self._hourglass(place, moved), self._mirror_defect(moved))

    def _hourglass(self, place: np.ndarray, moved: np.ndarray) -> tuple[float, float]:
        """A cell's four corners have eight freedoms: two translations, four of an affine motion, whose
        Green strain counts, and two that are checkerboard: |a|² beside |E|² (Δ/2)², mean squares both.
        """
        if self._cells.shape[1] == 0:
            return np.nan, np.nan
        body, corner = self._body, place[:, self._cells]
        checkerboard = np.einsum("k,dkc->dc", _SIGNS, moved[:, self._cells]) / 4.0
        along_x = (corner[:, 1] - corner[:, 0] + corner[:, 3] - corner[:, 2]) / (2.0 * body.spacing_x)
        along_y = (corner[:, 2] - corner[:, 0] + corner[:, 3] - corner[:, 1]) / (2.0 * body.spacing_y)
        gradient = np.stack((along_x, along_y), axis=1)
        strain = 0.5 * (np.einsum("dac,dbc->abc", gradient, gradient) - np.eye(2)[..., None])
        bad = float((checkerboard**2).sum())
        total = bad + 0.25 * body.mean_spacing**2 * float((strain**2).sum())
        amplitude = np.sqrt(bad / self._cells.shape[1]) / body.mean_spacing
        return (bad / total if total > 0.0 else 0.0), float(amplitude)

    def _mirror_defect(self, moved: np.ndarray) -> float:
        worst = np.nan
        for axis, partner in self._partners.items():
            sign = np.array((-1.0, 1.0) if axis == "x" else (1.0, -1.0))[:, None]
            off = np.hypot(*(moved[:, partner] - sign * moved)).max() / self._body.mean_spacing
            worst = np.fmax(worst, off)
        return float(worst)


def cells(body: Body) -> np.ndarray:
    """Corners [4, C] of all lattice cells with a particle of the same part at each: (0, 0), (1, 0),
    (0, 1), (1, 1).
    """
    if body.sites is None:
        return np.empty((4, 0), np.int64)
    column, row = body.sites
    steps = ((0, 0), (1, 0), (0, 1), (1, 1))
    corners = np.stack([at_site(body.sites, column + dc, row + dr) for dc, dr in steps])
    whole = (corners >= 0).all(axis=0)
    if body.part is not None:
        whole &= (body.part[corners] == body.part).all(axis=0)
    return corners[:, whole]


def partners(body: Body, axis: str) -> np.ndarray:
    """Index [N] of each particle's mirror image: the coordinate `axis` changes sign about the middle."""
    if body.sites is None:
        raise ValueError("a body without a lattice has no mirror images")
    image = body.sites.copy()
    row = image["xy".index(axis)]
    row[:] = row.min() + row.max() - row
    found = at_site(body.sites, *image)
    if (found < 0).any():
        raise ValueError(f"the lattice is not symmetric in {axis}")
    return found
