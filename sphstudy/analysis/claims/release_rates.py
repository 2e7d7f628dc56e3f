"""Claims about the crack's energy release rates in modes I and II (thesis 4.3, 4.4)."""

from sphstudy.analysis.claims.claim import Finding, claim
from sphstudy.analysis.claims.reading import (
    CRACK,
    because,
    best_smoothing,
    cells,
    choices,
    count,
    elsewhere,
    everywhere,
    falls,
    finding,
    interval,
    options,
    signed,
    span,
    whole_grid,
    within,
)
from sphstudy.analysis.results import Results
from sphstudy.text import percent

PROPAGATION_RANGE = {1: (-0.31, -0.17), 2: (-0.375, -0.175)}
"""By mode. I: -0.30 to -0.18, the ends of figure 4.12a's axis; II: -0.35, the end of figure 4.16a's axis,
to -0.20 (text: 20 to 30 %); and half a tick (0.01, 0.025) on either side.
"""

PROJECTION_RANGE = {1: (-5e-3, 9e-3), 2: (0.0275, 0.0475)}
"""By mode: -4e-3 to 8e-3 and 0.03 to 0.045, the ends of the axes of figures 4.12b and 4.16b, and half a
tick (1e-3, 0.0025) on either side.
"""

SMALL = 0.01
"""Projection errors are "typically a factor 100 smaller" than 20 to 30 %: below 1 %, with room."""

ABOUT_HALF = (4, 8)
"""How many of twelve are about half: six, two more or less."""

VARIATION = {1: (0.005, 0.015), 2: (0.0025, 0.01)}
"""By mode: what rounds to 1 %; 0.5 %, and a factor of two on either side."""

FROZEN = "method.retest_visibility=False"
"""Pairs separated by the crack are chosen once, in the first configuration, and never again."""


def _cause(results: Results, mode: int) -> str:
    """What G1 becomes by other choices, and with the visibility of the first configuration."""
    scene = f"mode{mode}"
    base, frozen = (
        elsewhere(results, "choices", scene, {"varied": changed}, "G1_error") for changed in ("", FROZEN)
    )
    numbers = (
        "with visibility frozen in the first configuration instead of tested at every step G1 is "
        f"{signed(frozen)} instead of {signed(base)} at (40, 1.5)"
        if base is not None and frozen is not None
        else ""
    )
    return because(numbers, options(results, scene, "G1_error"))


@claim(
    "C1",
    "Mode I: the error of G1 (propagation) is −0.18 to −0.30 everywhere and shrinks as n grows, "
    "except that (n, h̃) = (40, 1.5) is much lower than the trend.",
    "section 4.3, figure 4.12a",
    reproduced=f"all 12 in {interval(PROPAGATION_RANGE[1])}; the size falls in both steps of n at "
    "every h̃, but grows from (40, 1.5) to (50, 1.5)",
    partly="all negative, and either the range or the trend holds",
    otherwise="an error is positive, or neither range nor trend holds",
)
def propagation(results: Results) -> Finding:
    """Range and trend of G1's error."""
    errors = whole_grid(results, "G1_error", CRACK)
    fall = falls(errors)
    expected = fall.copy()
    expected.at[1.5, 50] = not fall.at[1.5, 50]
    inside = within(errors, *PROPAGATION_RANGE[1])
    negative = everywhere(errors < 0.0)
    in_range, trend = everywhere(inside), everywhere(expected)
    numbers = (
        f"{span(errors)}; {count(errors < 0.0)} of 12 negative, {count(inside)} in the range; the "
        f"size falls in {count(fall)} of {fall.size} steps of n; (40, 1.5): "
        f"{signed(errors.at[1.5, 40])}"
    )
    return finding(in_range and trend, negative and (in_range or trend), numbers, _cause(results, 1))


@claim(
    "D1",
    "Mode II: the error of G1 (propagation) is −0.20 to −0.35, falls slowly as n grows and is "
    "lowest at h̃ = 1.3 for each n; (n, h̃) = (40, 1.3) is exceptionally low and of the other "
    "sign.",
    "section 4.4, figure 4.16a",
    reproduced=f"all but (40, 1.3) in {interval(PROPAGATION_RANGE[2])}; the size falls in both steps "
    "of n at h̃ = 1.7 and 1.9 (1.5 is said to change only slightly), and is smallest at 1.3 for "
    "each n; (40, 1.3) is positive and the smallest of all",
    partly="the size falls at h̃ = 1.7 and 1.9 and is smallest at 1.3 for each n",
    otherwise="not even that",
)
def propagation_of_mode2(results: Results) -> Finding:
    """Range, trend and exception of G1's error."""
    errors = whole_grid(results, "G1_error", CRACK)
    inside = within(errors, *PROPAGATION_RANGE[2])
    odd = errors.at[1.3, 40]
    exceptional = odd > 0.0 and odd == errors.abs().min(axis=None)
    in_range = everywhere(inside.drop(index=1.3)) and everywhere(inside.loc[[1.3], [50, 60]])
    best = best_smoothing(errors)
    core = everywhere(falls(errors).loc[[1.7, 1.9]]) and bool((best == 1.3).all())
    numbers = (
        f"{span(errors)}; {count(inside)} of 12 in the range, positive: "
        f"{cells(errors > 0.0) or 'none'}; falls in {count(falls(errors))} of 8 steps of n; "
        f"smallest at h̃ = {choices(best)}; (40, 1.3): {signed(odd)}"
    )
    return finding(core and in_range and exceptional, core, numbers, _cause(results, 2))


@claim(
    "C2",
    "Mode I: the error of G2 (projection) is within −0.004 to +0.008, about half of either sign, "
    "smallest at h̃ = 1.5 for each n, and varies by about 1 % over h̃.",
    "section 4.3, figure 4.12b",
    reproduced=f"all 12 in {interval(PROJECTION_RANGE[1], 100.0)} %, {interval(ABOUT_HALF)} of them "
    "positive, for each n the size smallest at h̃ = 1.5 and largest less smallest value over h̃ "
    f"in {interval(VARIATION[1], 100.0)} %",
    partly=f"all sizes are below {percent(SMALL)} and {interval(ABOUT_HALF)} are positive",
    otherwise=f"a size of {percent(SMALL)} or more, or signs far from half and half",
)
def projection(results: Results) -> Finding:
    """Range, signs, best h̃ and variation of G2's error."""
    errors = whole_grid(results, "G2_error", CRACK)
    positive, best = count(errors > 0.0), best_smoothing(errors)
    variation, off = errors.max() - errors.min(), ~within(errors, *PROJECTION_RANGE[1])
    about_half = ABOUT_HALF[0] <= positive <= ABOUT_HALF[1]
    slight = bool(variation.between(*VARIATION[1]).all())
    everything = not off.any(axis=None) and about_half and bool((best == 1.5).all()) and slight
    numbers = (
        f"{span(errors)}, {positive} of 12 positive; smallest at h̃ = {choices(best)}; varies over "
        "h̃ by " + ", ".join(map(percent, variation))
    )
    if off.any(axis=None):
        numbers += f"; outside the range: {cells(off)}"
    cause = because(
        f"over h̃ the error falls from {signed(errors.loc[1.3].mean())} to "
        f"{signed(errors.loc[1.9].mean())} (means over n) and its size is smallest where it passes "
        f"through zero; at h̃ = 1.5 it is still {signed(errors.loc[1.5].mean())}",
        options(results, "mode1", "G2_error"),
    )
    return finding(everything, everywhere(errors.abs() < SMALL) and about_half, numbers, cause)


@claim(
    "D2",
    "Mode II: the error of G2 (projection) is +0.03 to +0.045, falls as n grows, is smallest at "
    "h̃ = 1.9 and varies by about 0.5 % over h̃.",
    "section 4.4, figure 4.16b",
    reproduced=f"all 12 in {interval(PROJECTION_RANGE[2])}, falling in both steps of n at every h̃, "
    "smallest at h̃ = 1.9 for each n, largest less smallest over h̃ in "
    f"{interval(VARIATION[2], 100.0)} % for each n",
    partly="all positive and falling, smallest at h̃ = 1.9 for each n",
    otherwise="not even that",
)
def projection_of_mode2(results: Results) -> Finding:
    """Range, trend, best h̃ and variation of G2's error."""
    errors = whole_grid(results, "G2_error", CRACK)
    best, variation = best_smoothing(errors), errors.max() - errors.min()
    core = everywhere(errors > 0.0) and everywhere(falls(errors)) and bool((best == 1.9).all())
    slight = bool(variation.between(*VARIATION[2]).all())
    numbers = (
        f"{span(errors)}; falls in {count(falls(errors))} of 8 steps of n; smallest at h̃ = "
        f"{choices(best)}; varies over h̃ by {', '.join(map(percent, variation))}"
    )
    inside = everywhere(within(errors, *PROJECTION_RANGE[2]))
    return finding(core and slight and inside, core, numbers, options(results, "mode2", "G2_error"))
