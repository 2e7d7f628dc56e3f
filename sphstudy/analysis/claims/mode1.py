"""Claims about the crack in mode I (thesis 4.3)."""

from sphstudy.analysis.claims.claim import REPRODUCED, Finding, claim
from sphstudy.analysis.claims.crack import DISPLACEMENTS, STRESSES, frozen_visibility, norms
from sphstudy.analysis.claims.reading import (
    CRACK,
    because,
    best_smoothing,
    cells,
    choices,
    count,
    everywhere,
    falls,
    interval,
    options,
    percent,
    size,
    span,
    verdict,
    whole_grid,
    within,
)
from sphstudy.analysis.results import Results
from sphstudy.text import number

PROPAGATION_RANGE = (-0.31, -0.17)
"""-0.30 to -0.18, the ends of figure 4.12a's axis, and half a tick (0.01) on either side."""

PROJECTION_RANGE = (-5e-3, 9e-3)
"""-4e-3 to 8e-3, the ends of figure 4.12b's axis, and half a tick (1e-3) on either side."""

SMALL = 0.01
"""Projection errors are "typically a factor 100 smaller" than 20 to 30 %: below 1 %, with room."""

ABOUT_HALF = (4, 8)
"""How many of twelve are about half: six, two more or less."""

ABOUT_1_PERCENT = (0.005, 0.015)
"""What rounds to 1 %."""


@claim(
    "C1",
    "Mode I: the error of G1 (propagation) is −0.18 to −0.30 everywhere and shrinks as n grows, "
    "except that (n, h̃) = (40, 1.5) is much lower than the trend.",
    "section 4.3, figure 4.12a",
    reproduced=f"all 12 in {interval(PROPAGATION_RANGE)}; the size falls in both steps of n at "
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
    inside = within(errors, *PROPAGATION_RANGE)
    negative = everywhere(errors < 0.0)
    in_range, trend = everywhere(inside), everywhere(expected)
    found = verdict(in_range and trend, negative and (in_range or trend))
    told = (
        f"{span(errors)}; {count(errors < 0.0)} of 12 negative, {count(inside)} in the range; the "
        f"size falls in {count(fall)} of {fall.size} steps of n; (40, 1.5): "
        f"{percent(errors.at[1.5, 40])}"
    )
    cause = because(frozen_visibility(results, "mode1"), options(results, "mode1", "G1_error"))
    return Finding(found, told, "" if found == REPRODUCED else cause)


@claim(
    "C2",
    "Mode I: the error of G2 (projection) is within −0.004 to +0.008, about half of either sign, "
    "smallest at h̃ = 1.5 for each n, and varies by about 1 % over h̃.",
    "section 4.3, figure 4.12b",
    reproduced=f"all 12 in {interval(PROJECTION_RANGE, 100.0)} %, {interval(ABOUT_HALF)} of them "
    "positive, for each n the size smallest at h̃ = 1.5 and largest less smallest value over h̃ "
    f"in {interval(ABOUT_1_PERCENT, 100.0)} %",
    partly=f"all sizes are below {size(SMALL)} and {interval(ABOUT_HALF)} are positive",
    otherwise=f"a size of {size(SMALL)} or more, or signs far from half and half",
)
def projection(results: Results) -> Finding:
    """Range, signs, best h̃ and variation of G2's error."""
    errors = whole_grid(results, "G2_error", CRACK)
    positive, best = count(errors > 0.0), best_smoothing(errors)
    variation = errors.max() - errors.min()
    about_half = ABOUT_HALF[0] <= positive <= ABOUT_HALF[1]
    found = verdict(
        everywhere(within(errors, *PROJECTION_RANGE))
        and about_half
        and bool((best == 1.5).all())
        and bool(variation.between(*ABOUT_1_PERCENT).all()),
        everywhere(errors.abs() < SMALL) and about_half,
    )
    told = (
        f"{span(errors)}, {positive} of 12 positive; smallest at h̃ = {choices(best)}; varies over "
        "h̃ by " + ", ".join(map(size, variation))
    )
    off = ~within(errors, *PROJECTION_RANGE)
    if off.any(axis=None):
        told += f"; outside the range: {cells(off)}"
    cause = because(
        f"over h̃ the error falls from {percent(errors.loc[1.3].mean())} to "
        f"{percent(errors.loc[1.9].mean())} (means over n) and its size is smallest where it passes "
        f"through zero; at h̃ = 1.5 it is still {percent(errors.loc[1.5].mean())}",
        options(results, "mode1", "G2_error"),
    )
    return Finding(found, told, "" if found == REPRODUCED else cause)


@claim(
    "C3",
    "Mode I: the norms of the displacement errors fall as n grows and favour low h̃; at large h̃ "
    "they fall faster.",
    "section 4.3, figure 4.13a",
    reproduced="rms errors of u_x and u_y fall in both steps of n at every h̃; for each n they "
    "are smallest at h̃ = 1.3 or 1.5 and largest at 1.9; from n = 40 to 60 they fall by more at "
    "1.9 than at 1.3",
    partly="they fall everywhere, and are smallest and largest there",
    otherwise="not even that",
)
def displacement_norms(results: Results) -> Finding:
    """Trends of the displacement norms."""
    grids = norms(results, DISPLACEMENTS)
    fall = sum(count(falls(grid)) for grid in grids.values())
    steps = sum(falls(grid).size for grid in grids.values())
    favoured = all(
        bool(best_smoothing(g).isin([1.3, 1.5]).all() and (g.idxmax() == 1.9).all())
        for g in grids.values()
    )
    drop = {field: grid[40] - grid[60] for field, grid in grids.items()}
    faster = all(lost[1.9] > lost[1.3] for lost in drop.values())
    falling = fall == steps
    found = verdict(falling and favoured and faster, falling and favoured)
    told = f"fall in {fall} of {steps} steps; " + "; ".join(
        f"{field} smallest at h̃ = {choices(best_smoothing(grid))}, falls from n = 40 to 60 by "
        f"{number(1e6 * drop[field][1.3], 3)} µm (1.3), {number(1e6 * drop[field][1.9], 3)} µm (1.9)"
        for field, grid in grids.items()
    )
    return Finding(found, told)


@claim(
    "C4",
    "Mode I: the norms of the stress errors fall as n grows; σxx and σyy favour h̃ = 1.3 to 1.5, "
    "σxy is worse at 1.3.",
    "section 4.3, figure 4.13b",
    reproduced="rms errors fall in both steps of n at every h̃; for each n those of σxx and σyy "
    "are smallest at h̃ = 1.3 or 1.5, and that of σxy is larger at 1.3 than at 1.5",
    partly="they fall, and one of the other two holds",
    otherwise="one of them does not fall, or neither of the other two holds",
)
def stress_norms(results: Results) -> Finding:
    """Trends of the stress norms."""
    grids = norms(results, STRESSES)
    fall = sum(count(falls(grid)) for grid in grids.values())
    steps = sum(falls(grid).size for grid in grids.values())
    normal = STRESSES[:2]
    favoured = all(bool(best_smoothing(grids[field]).isin([1.3, 1.5]).all()) for field in normal)
    shear = grids["stress_xy"]
    worse = bool((shear.loc[1.3] > shear.loc[1.5]).all())
    falling = fall == steps
    found = verdict(falling and favoured and worse, falling and (favoured or worse))
    told = (
        f"fall in {fall} of {steps} steps; smallest at h̃: "
        + "; ".join(f"{field} {choices(best_smoothing(grids[field]))}" for field in normal)
        + "; stress_xy at 1.3 over 1.5: "
        + ", ".join(number(ratio, 3) for ratio in shear.loc[1.3] / shear.loc[1.5])
    )
    if found == REPRODUCED:
        return Finding(found, told)
    inner = norms(results, normal, "rms_inner")
    elsewhere = "; ".join(f"{field} {choices(best_smoothing(grid))}" for field, grid in inner.items())
    cause = (
        f"the few particles at the singular tip decide: without tip and frame smallest at h̃: {elsewhere}"
    )
    return Finding(found, told, cause)
