"""Von Mises stress of a plane state."""

import numpy as np


def von_mises(
    stress_xx: np.ndarray,
    stress_yy: np.ndarray,
    stress_xy: np.ndarray,
    plane: str,
    poisson_ratio: float,
) -> np.ndarray:
    """Von Mises stress √(½((σxx-σyy)² + (σyy-σzz)² + (σzz-σxx)²) + 3σxy²).

    The thesis does not say which σzz it draws; here the state of the body that was computed decides.

    Parameters
    ----------
    stress_xx, stress_yy, stress_xy : array
        Stresses, in one unit and of one shape.
    plane : {"strain", "stress"}
        strain: σzz = ν (σxx + σyy), which keeps the thickness; stress: σzz = 0.
    poisson_ratio : float
        ν.

    Returns
    -------
    array
        In the unit and shape of the stresses.
    """
    xx, yy, xy = np.asarray(stress_xx), np.asarray(stress_yy), np.asarray(stress_xy)
    zz = poisson_ratio * (xx + yy) if plane == "strain" else 0.0
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2)
