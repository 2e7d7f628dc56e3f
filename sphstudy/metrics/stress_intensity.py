"""K_I, K_II and J of a run by integrals over annuli about the crack tip, whatever the method.

The displacement gradient follows from recorded positions by a corrected gradient in the reference
configuration, with the crack's bonds cut; stresses are those recorded.
"""

import numpy as np
import xarray as xr

from sphstudy.metrics.interaction_integral import Annulus, fits, j_integral, stress_intensities
from sphstudy.metrics.metric import Metric, body, pure, snapshot
from sphstudy.model.exact import williams
from sphstudy.model.problem import Body
from sphstudy.numerics.sph import bonds, constitutive, kernel, total_lagrangian
from sphstudy.numerics.sph.crack import Crack

WHOLE = (0.1, 0.4)
"""Radii of the annulus in sides of the square (20 to 80 mm): clear of the tip and of the frame in all
cells of the thesis's grids."""

PARTS = ((0.1, 0.25), (0.175, 0.325), (0.25, 0.4))
"""Narrower annuli, inside the first: what they differ by is the contour dependence."""


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Metrics of the settled state with crack length a; NaN where the annulus does not fit."""
    scene, side = config.scene, config.scene.L
    exact = {"K_I": scene.K if scene.mode == 1 else 0.0, "K_II": scene.K if scene.mode == 2 else 0.0}
    release = williams.energy_release_rate(scene.K, scene.E)
    whole, *parts = (Annulus(inner * side, outer * side) for inner, outer in (WHOLE, *PARTS))
    shape = kernel.KERNELS[config.method.kernel]
    edge = 0.5 * side - scene.frame_layers * float(run["spacing_x"])
    remark = fits(whole, shape.support * config.h * float(run["spacing_x"]), edge)
    values = np.full((1 + len(parts), 3), np.nan)
    if not remark:
        values = _integrals(run, config, (whole, *parts))
    k_1, k_2, j = values[0]
    spread = np.ptp(values[1:], axis=0) / (scene.K, scene.K, release)
    annulus = "by integration over an annulus"
    found = {
        "K_I_integral": Metric(k_1, "Pa m0.5", f"K_I {annulus}", remark),
        "K_II_integral": Metric(k_2, "Pa m0.5", f"K_II {annulus}"),
        "J": Metric(j, "J m-2", f"J {annulus}"),
        "K_I_integral_error": pure((k_1 - exact["K_I"]) / scene.K, f"error of K_I {annulus} over K"),
        "K_II_integral_error": pure((k_2 - exact["K_II"]) / scene.K, f"error of K_II {annulus} over K"),
        "J_error": pure(j / release - 1.0, "relative error of J"),
    }
    for name, difference in zip(("K_I", "K_II", "J"), spread, strict=True):
        found[f"{name}_contour_spread"] = pure(
            difference, f"largest difference of {name} between three annuli, over the exact value"
        )
    return found


def _integrals(run: xr.Dataset, config, annuli: tuple[Annulus, ...]) -> np.ndarray:
    """K_I, K_II (Pa √m) and J (J/m²) of each annulus [annuli, 3]."""
    scene, square, state = config.scene, body(run, config), snapshot(run, "settle")
    area = square.mass / square.material.density
    gradient = _deformation_gradient(square, area, config, state["x"].values, state["y"].values)
    stress, density = _stress_and_energy(square.material, config, state, gradient)
    displacement_gradient = gradient - np.array([1.0, 0.0, 0.0, 1.0])[:, None]
    values = []
    for annulus in annuli:
        place = (square.x, square.y, area, stress, displacement_gradient)
        k = stress_intensities(*place, annulus, 0.0, scene.E, scene.nu)
        values.append((*k, j_integral(*place, density, annulus, 0.0)))
    return np.array(values)


def _deformation_gradient(
    square: Body, area: np.ndarray, config, x: np.ndarray, y: np.ndarray
) -> np.ndarray:
    """F [4, N], corrected, of positions x, y [N] (m)."""
    # The rows beside the crack carry its nodes, column by column.
    faces = square.tags["faces"]
    crack = Crack(np.flatnonzero(faces & (square.y < 0.0)), np.flatnonzero(faces & (square.y > 0.0)))
    shape = kernel.KERNELS[config.method.kernel]
    pairs = bonds.build(square.x, square.y, area, shape, config.h * square.mean_spacing, crack)
    found = np.zeros((4, x.size))
    correction = total_lagrangian.correction(pairs, square.x, square.y)
    total_lagrangian.corrected_gradient(None, pairs, correction, x, y, found)
    return found


def _stress_and_energy(
    material, config, state: xr.Dataset, gradient: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """First Piola–Kirchhoff stress [4, N] (Pa) and energy per reference volume [N] (J/m³).

    Small strain under a linear law; otherwise P = J σ F⁻ᵀ. A method without a law of its own has the
    energy of Hooke's law from its stress.
    """
    xx, yy, xy = (state[f"stress_{c}"].values for c in ("xx", "yy", "xy"))
    e, nu = material.compliance
    density = (xx**2 + yy**2 - 2.0 * nu * xx * yy + 2.0 * (1.0 + nu) * xy**2) / (2.0 * e)
    name = getattr(config.method, "law", None)
    if name == "linear":
        return np.stack((xx, xy, xy, yy)), density
    f_xx, f_xy, f_yx, f_yy = gradient
    stress = np.stack(
        (xx * f_yy - xy * f_xy, xy * f_xx - xx * f_yx, xy * f_yy - yy * f_xy, yy * f_xx - xy * f_yx)
    )
    if name is None:
        return stress, density * (f_xx * f_yy - f_xy * f_yx)
    return stress, constitutive.energy_densities(constitutive.law(name, material), gradient)
