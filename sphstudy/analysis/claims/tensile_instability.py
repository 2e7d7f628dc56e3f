"""Which side of a bent body a kernel makes unstable, and what the study `conjectures` found about it."""

from sphstudy.analysis.claims.reading import elsewhere, signed
from sphstudy.analysis.results import Results
from sphstudy.numerics.sph.kernel import KERNELS, curvature
from sphstudy.text import number, percent

INFLECTION = 1e-9
"""A curvature h⁴ W'' smaller than this is zero but for rounding: the neighbour sits on the inflection."""

FULL, THOUSANDTH = 0.02, 2.0e-5
"""Amplitudes H0 of the plate in `conjectures`: the thesis's, and a thousandth of it."""


def curvature_at_neighbour(smoothing: float, kernel: str) -> float:
    """h⁴ W'' at the nearest neighbour of a lattice, r = Δ = h/h̃."""
    return float(KERNELS[kernel].scale * curvature(KERNELS[kernel], 1.0 / smoothing))


def unstable_side(smoothing: float) -> str:
    """In words: the sign of W'' at the nearest neighbour, and the stress that is unstable with it."""
    bend = curvature_at_neighbour(smoothing, "cubic")
    place = f"at h̃ = {smoothing:g} the nearest neighbour sits"
    if abs(bend) < INFLECTION:
        return f"{place} on the kernel's inflection, W'' = 0"
    side = "tension" if bend > 0.0 else "compression"
    return f"{place} where h⁴ W'' = {number(bend, 2, sign=True)}, unstable in {side}"


def plate_test(
    results: Results, smoothing: float, kernel: str, stress: float, amplitude: float
) -> tuple[float, float] | None:
    """Frequency error, and roughness below the axis, of the plate of 15 rows in `conjectures`.

    stress: ζ of the artificial stress. None if the point is not in the store.
    """
    settings = {
        "h": smoothing,
        "method.kernel": kernel,
        "method.artificial_stress": stress,
        "scene.H0": amplitude,
    }
    error, rough = (
        elsewhere(results, "conjectures", "plate", settings, metric)
        for metric in ("frequency_error", "stress_roughness_bottom")
    )
    return None if error is None or rough is None else (error, rough)


def kernel_test(results: Results, smoothing: float) -> str:
    """In words: the plate of 15 rows at this h̃ with other kernels, and with hardly any stress.

    Empty if the study `conjectures` lacks these points.
    """
    cases = [(_kernel_words(kernel, smoothing), kernel, FULL) for kernel in KERNELS]
    cases.append(("cubic kernel at a thousandth of the amplitude", "cubic", THOUSANDTH))
    numbers = [
        f"{words} {signed(found[0])}, {percent(found[1])}"
        for words, kernel, amplitude in cases
        if (found := plate_test(results, smoothing, kernel, 0.0, amplitude))
    ]
    return (
        f"ω error and roughness below the axis at (15, {smoothing:g}): {'; '.join(numbers)}"
        if numbers
        else ""
    )


def _kernel_words(kernel: str, smoothing: float) -> str:
    bend = number(curvature_at_neighbour(smoothing, kernel), 2, sign=True)
    return f"{kernel} kernel (h⁴ W'' = {bend})"
