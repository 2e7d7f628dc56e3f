"""Lattices of particles: positions, columns and rows, neighbouring sites, noise."""

import numpy as np


def centred(count: int, spacing: float) -> np.ndarray:
    """Coordinates [count] of a line of particles about 0, in the unit of their spacing."""
    return spacing * (np.arange(count) - 0.5 * (count - 1))


def lattice(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions of all particles of a lattice, x fastest.

    Parameters
    ----------
    x, y : array [columns], array [rows]
        Coordinates of columns and rows (m).

    Returns
    -------
    array [columns · rows], array [columns · rows]
        Coordinates of the particles (m).
    """
    grid_y, grid_x = np.meshgrid(y, x, indexing="ij")
    return grid_x.ravel(), grid_y.ravel()


def lattice_sites(columns: int, rows: int) -> np.ndarray:
    """Column and row [2, columns · rows] of each particle of a lattice, in the order of `lattice`."""
    return np.stack([axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows))])


def square(side: float, n: int) -> tuple[np.ndarray, np.ndarray, float]:
    """A lattice of square cells that fill a square about the origin.

    Parameters
    ----------
    side : float
        Of the square (m).
    n : int
        Particles along a side.

    Returns
    -------
    array [n²], array [n²], float
        Coordinates of the particles, and their spacing (m).
    """
    line = centred(n, side / n)
    return *lattice(line, line), side / n


def noise(particles: int, amplitude: float, seed: int) -> np.ndarray:
    """Random displacements, the same for the same seed.

    Parameters
    ----------
    particles : int
        How many.
    amplitude : float
        Largest displacement along a coordinate (m).
    seed : int
        Of the random numbers.

    Returns
    -------
    array [2, particles]
        Displacements (m), uniform between ± amplitude.
    """
    return np.random.default_rng(seed).uniform(-amplitude, amplitude, (2, particles))


def at_site(sites: np.ndarray, column: np.ndarray, row: np.ndarray) -> np.ndarray:
    """Which particles stand at given sites of a lattice.

    Parameters
    ----------
    sites : array [2, N]
        Column and row of each particle.
    column, row : array [...]
        The sites.

    Returns
    -------
    array [...]
        Index of the particle; -1 where there is none.
    """
    low = sites.min(axis=1) - 1
    height = sites[1].max() - low[1] + 2
    own = (sites[0] - low[0]) * height + sites[1] - low[1]
    wanted = (column - low[0]) * height + row - low[1]
    order = np.argsort(own)
    place = np.minimum(np.searchsorted(own[order], wanted), own.size - 1)
    return np.where(own[order][place] == wanted, order[place], -1)
