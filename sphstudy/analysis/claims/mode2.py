"""Claims about the crack in mode II (thesis 4.4, 5.3)."""

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
from sphstudy.analysis.claims.stability import conjecture
from sphstudy.analysis.results import Results

PROPAGATION_RANGE = (-0.375, -0.175)
"""-0.35 (end of figure 4.16a's axis) to -0.20 (text: 20 to 30 %), and half a tick (0.025) on either
side.
"""

PROJECTION_RANGE = (0.0275, 0.0475)
"""0.03 to 0.045, the ends of figure 4.16b's axis, and half a tick (0.0025) on either side."""

ABOUT_HALF_PERCENT = (0.0025, 0.01)
"""0.5 %, and a factor of two on either side."""

UNEQUAL = 0.1
"""Parity defect from which on two curves that should be mirror images are seen not to be."""

DRAWN = {"h": 1.7, "n": 60}
"""The cell of figure 4.15."""


@claim(
    "D1",
    "Mode II: the error of G1 (propagation) is −0.20 to −0.35, falls slowly as n grows and is "
    "lowest at h̃ = 1.3 for each n; (n, h̃) = (40, 1.3) is exceptionally low and of the other "
    "sign.",
    "section 4.4, figure 4.16a",
    reproduced=f"all but (40, 1.3) in {interval(PROPAGATION_RANGE)}; the size falls in both steps "
    "of n at h̃ = 1.7 and 1.9 (1.5 is said to change only slightly), and is smallest at 1.3 for "
    "each n; (40, 1.3) is positive and the smallest of all",
    partly="the size falls at h̃ = 1.7 and 1.9 and is smallest at 1.3 for each n",
    otherwise="not even that",
)
def propagation(results: Results) -> Finding:
    """Range, trend and exception of G1's error."""
    errors = whole_grid(results, "G1_error", CRACK)
    inside = within(errors, *PROPAGATION_RANGE)
    odd = errors.at[1.3, 40]
    exceptional = odd > 0.0 and odd == errors.abs().min(axis=None)
    in_range = everywhere(inside.drop(index=1.3)) and everywhere(inside.loc[[1.3], [50, 60]])
    best = best_smoothing(errors)
    core = everywhere(falls(errors).loc[[1.7, 1.9]]) and bool((best == 1.3).all())
    found = verdict(core and in_range and exceptional, core)
    told = (
        f"{span(errors)}; {count(inside)} of 12 in the range, positive: "
        f"{cells(errors > 0.0) or 'none'}; falls in {count(falls(errors))} of 8 steps of n; "
        f"smallest at h̃ = {choices(best)}; (40, 1.3): {percent(odd)}"
    )
    cause = because(frozen_visibility(results, "mode2"), options(results, "mode2", "G1_error"))
    return Finding(found, told, "" if found == REPRODUCED else cause)


@claim(
    "D2",
    "Mode II: the error of G2 (projection) is +0.03 to +0.045, falls as n grows, is smallest at "
    "h̃ = 1.9 and varies by about 0.5 % over h̃.",
    "section 4.4, figure 4.16b",
    reproduced=f"all 12 in {interval(PROJECTION_RANGE)}, falling in both steps of n at every h̃, "
    "smallest at h̃ = 1.9 for each n, largest less smallest over h̃ in "
    f"{interval(ABOUT_HALF_PERCENT, 100.0)} % for each n",
    partly="all positive and falling, smallest at h̃ = 1.9 for each n",
    otherwise="not even that",
)
def projection(results: Results) -> Finding:
    """Range, trend, best h̃ and variation of G2's error."""
    errors = whole_grid(results, "G2_error", CRACK)
    best, variation = best_smoothing(errors), errors.max() - errors.min()
    core = everywhere(errors > 0.0) and everywhere(falls(errors)) and bool((best == 1.9).all())
    slight = bool(variation.between(*ABOUT_HALF_PERCENT).all())
    found = verdict(core and slight and everywhere(within(errors, *PROJECTION_RANGE)), core)
    told = (
        f"{span(errors)}; falls in {count(falls(errors))} of 8 steps of n; smallest at h̃ = "
        f"{choices(best)}; varies over h̃ by {', '.join(map(size, variation))}"
    )
    cause = options(results, "mode2", "G2_error")
    return Finding(found, told, "" if found == REPRODUCED else cause)


@claim(
    "D3",
    "Mode II: all norms of errors fall as n grows and are lowest at h̃ = 1.3.",
    "section 4.4, figure 4.17",
    reproduced="rms errors of u_x, u_y, σxx, σyy and σxy fall in both steps of n at every h̃ and "
    "are smallest at h̃ = 1.3 for each n: 40 and 15 comparisons",
    partly="all fall, and at least 8 of the 15 are smallest at h̃ = 1.3",
    otherwise="not even that",
)
def error_norms(results: Results) -> Finding:
    """Trends of all norms."""
    grids = norms(results, DISPLACEMENTS + STRESSES)
    fall = sum(count(falls(grid)) for grid in grids.values())
    lowest = {field: best_smoothing(grid) for field, grid in grids.items()}
    right = sum(int((best == 1.3).sum()) for best in lowest.values())
    found = verdict(fall == 40 and right == 15, fall == 40 and 2 * right > 15)
    told = f"fall in {fall} of 40 steps; smallest at h̃ = 1.3 in {right} of 15"
    if found == REPRODUCED:
        return Finding(found, told)
    others = [
        f"{field} at n = {n}: h̃ = {h:g}, there "
        f"{size(1.0 - grids[field].at[h, n] / grids[field].at[1.3, n])} below that at 1.3"
        for field, best in lowest.items()
        for n, h in best.items()
        if h != 1.3
    ]
    return Finding(found, told, f"lower at another h̃: {because(*others)}")


@claim(
    "D4",
    "Mode II: σxx and σyy lose their antisymmetry in y near the tip.",
    "sections 4.4 and 5.3, figures 4.15a, b",
    reproduced="at (60, 1.7) in the rows beside y = 0, up to 25 mm ahead of the tip, the even "
    f"part of σxx and that of σyy are at least {size(UNEQUAL)} of the odd part (rms)",
    partly="that of one of the two is",
    otherwise="that of neither is",
)
def antisymmetry(results: Results) -> Finding:
    """Parity defects ahead of the tip, and what becomes of them without load or artificial stress."""
    grids = {
        name: whole_grid(results, f"stress_{name}_parity_defect_ahead", CRACK) for name in ("xx", "yy")
    }
    seen = [float(grid.at[DRAWN["h"], DRAWN["n"]]) >= UNEQUAL for grid in grids.values()]
    told = "; ".join(
        f"σ{name} {size(grid.at[DRAWN['h'], DRAWN['n']])} "
        f"(all cells {size(grid.min(axis=None))} to {size(grid.max(axis=None))})"
        for name, grid in grids.items()
    )
    return Finding(verdict(all(seen), any(seen)), because(told, _what_breaks_it(results)))


def _what_breaks_it(results: Results) -> str:
    """In words: the defects at (40, 1.7) by load and artificial stress. Empty if they are not stored."""
    told = []
    for load, words in ((35.8e3, "full load"), (35.8, "a thousandth of the load")):
        for stress, how in ((0.3, "with"), (0.0, "without")):
            settings = {"h": 1.7, "scene.K": load, "method.artificial_stress": stress}
            found = [
                conjecture(results, "mode2", settings, f"stress_{name}_parity_defect_ahead")
                for name in ("xx", "yy")
            ]
            values = [size(value) for value in found if value is not None]
            if len(values) == 2:
                told.append(f"{words}, {how} artificial stress {' and '.join(values)}")
    return f"σxx and σyy at (40, 1.7): {'; '.join(told)}" if told else ""
