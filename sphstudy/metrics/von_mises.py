"""Von Mises stress of a plane state."""

import numpy as np


def von_mises(
    stress_xx: np.ndarray,
    stress_yy: np.ndarray,
    stress_xy: np.ndarray,
    plane: str,
    poisson_ratio: float,
) -> np.ndarray:
    """√(½((σxx-σyy)² + (σyy-σzz)² + (σzz-σxx)²) + 3σxy²) in the unit of the stresses, arrays of any
    shape.

    plane "strain": σzz = ν (σxx + σyy), which keeps the thickness; plane "stress": σzz = 0. The thesis
    does not say which of the two it draws; the state of the body that was computed decides here.
    """
    xx, yy, xy = np.asarray(stress_xx), np.asarray(stress_yy), np.asarray(stress_xy)
    zz = poisson_ratio * (xx + yy) if plane == "strain" else 0.0
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2)
