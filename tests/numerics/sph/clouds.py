"""Small bodies for tests: a random cloud with a crack, a lattice, and models with chosen terms."""

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.numerics.sph import kernel
from sphstudy.numerics.sph.artificial_stress import ArtificialStress
from sphstudy.numerics.sph.crack import Crack
from sphstudy.numerics.sph.updated_lagrangian import Model
from sphstudy.numerics.sph.viscosity import Viscosity

NOBODY = np.empty(0, np.int64)
FREE = Constraints(NOBODY, np.empty(0), NOBODY, np.empty(0))
TERMS = ("xsph", "viscosity", "artificial", "spin", "crack")


def lattice_positions(columns=9, rows=8):
    """Positions [2, N] on a unit lattice, x fastest."""
    y, x = np.meshgrid(np.arange(rows, dtype=float), np.arange(columns, dtype=float), indexing="ij")
    return np.array([x.ravel(), y.ravel()])


def random_state(rng, positions):
    """A state [8, N] around unit density with velocities and stresses of order one."""
    count = positions.shape[1]
    state = rng.normal(size=(8, count))
    state[:2] = positions
    state[4] = rng.uniform(0.8, 1.2, count)
    return state


def random_cloud(rng, count=60):
    """Positions [2, N] of a jittered lattice in random order: no two particles coincide."""
    positions = lattice_positions(10, 10)[:, rng.permutation(100)[:count]]
    return positions + rng.uniform(-0.3, 0.3, positions.shape)


def middle_crack(positions):
    """A crack of four nodes that float between particles below and above the middle of the cloud."""
    x, y = positions
    middle = np.median(y)
    below = [np.argmin((x - c) ** 2 + (y - middle + 0.5) ** 2) for c in (1.0, 3.0, 4.5, 6.0)]
    above = [np.argmin((x - c) ** 2 + (y - middle - 0.6) ** 2) for c in (1.0, 3.0, 4.5, 6.0)]
    return Crack(np.array(below, np.int64), np.array(above, np.int64))


def model(rng, positions, terms=TERMS, constraints=FREE, damping=None, smoothing=None, shape="cubic"):
    """A model of unequal masses with the terms named."""
    count, length = positions.shape[1], 1.5
    shape = kernel.KERNELS[shape]
    return Model(
        mass=rng.uniform(0.5, 1.5, count),
        kernel=shape,
        smoothing_length=length,
        normalisation=shape.normalisation(length),
        skin=0.15,
        lame_modulus=1.3,
        shear_modulus=0.7,
        bulk_modulus=2.0,
        constraints=constraints,
        prescribe_smoothed=True,
        prescribe_again=True,
        xsph=0.5 if "xsph" in terms else None,
        viscosity=Viscosity(1.0, 2.0) if "viscosity" in terms else None,
        artificial=ArtificialStress(0.3, 4, float(kernel.value(shape, 1.0 / 1.5)))
        if "artificial" in terms
        else None,
        spin=True if "spin" in terms else None,
        damping=damping,
        smoothing=smoothing,
        crack=middle_crack(positions) if "crack" in terms else None,
    )
