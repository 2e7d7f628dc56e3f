"""Claims about the fields of the crack in modes I and II (thesis 4.3, 4.4, 5.3)."""

import pandas as pd

from sphstudy.analysis.claims.claim import REPRODUCED, Finding, claim
from sphstudy.analysis.claims.reading import (
    CRACK,
    because,
    best_smoothing,
    choices,
    count,
    elsewhere,
    falls,
    finding,
    whole_grid,
)
from sphstudy.analysis.results import Results
from sphstudy.text import number, percent

DISPLACEMENTS, STRESSES = ("u_x", "u_y"), ("stress_xx", "stress_yy", "stress_xy")

UNEQUAL = 0.1
"""Parity defect from which on two curves that should be mirror images are seen not to be."""

DRAWN = {"h": 1.7, "n": 60}
"""The cell of figure 4.15."""


def norms(results: Results, fields: tuple[str, ...], kind: str = "rms") -> dict[str, pd.DataFrame]:
    """Error norms over the thesis's grid.

    Parameters
    ----------
    results : Results
        A crack's.
    fields : tuple of str
        Of DISPLACEMENTS and STRESSES.
    kind : {"rms", "rms_inner"}
        Over all particles, or without frame and tip.
    """
    return {field: whole_grid(results, f"{field}_{kind}", CRACK) for field in fields}


def _falling(grids: dict[str, pd.DataFrame]) -> tuple[int, int]:
    """In how many steps of n the norms fall, and of how many."""
    fall = [falls(grid) for grid in grids.values()]
    return sum(map(count, fall)), sum(grid.size for grid in fall)


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
    fall, steps = _falling(grids)
    favoured = all(
        bool(best_smoothing(g).isin([1.3, 1.5]).all() and (g.idxmax() == 1.9).all())
        for g in grids.values()
    )
    drop = {field: grid[40] - grid[60] for field, grid in grids.items()}
    faster = all(lost[1.9] > lost[1.3] for lost in drop.values())
    numbers = f"fall in {fall} of {steps} steps; " + "; ".join(
        f"{field} smallest at h̃ = {choices(best_smoothing(grid))}, falls from n = 40 to 60 by "
        f"{number(1e6 * drop[field][1.3], 3)} µm (1.3), {number(1e6 * drop[field][1.9], 3)} µm (1.9)"
        for field, grid in grids.items()
    )
    return finding(fall == steps and favoured and faster, fall == steps and favoured, numbers)


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
    fall, steps = _falling(grids)
    normal = STRESSES[:2]
    favoured = all(bool(best_smoothing(grids[field]).isin([1.3, 1.5]).all()) for field in normal)
    shear = grids["stress_xy"]
    worse = bool((shear.loc[1.3] > shear.loc[1.5]).all())
    numbers = (
        f"fall in {fall} of {steps} steps; smallest at h̃: "
        + "; ".join(f"{field} {choices(best_smoothing(grids[field]))}" for field in normal)
        + "; stress_xy at 1.3 over 1.5: "
        + ", ".join(number(ratio, 3) for ratio in shear.loc[1.3] / shear.loc[1.5])
    )
    found = finding(fall == steps and favoured and worse, fall == steps and (favoured or worse), numbers)
    if found.verdict == REPRODUCED:
        return found
    inner = norms(results, normal, "rms_inner")
    elsewhere = "; ".join(f"{field} {choices(best_smoothing(grid))}" for field, grid in inner.items())
    cause = (
        f"the few particles at the singular tip decide: without tip and frame smallest at h̃: {elsewhere}"
    )
    return Finding(found.verdict, numbers, cause)


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
    fall, _ = _falling(grids)
    lowest = {field: best_smoothing(grid) for field, grid in grids.items()}
    right = sum(int((best == 1.3).sum()) for best in lowest.values())
    numbers = f"fall in {fall} of 40 steps; smallest at h̃ = 1.3 in {right} of 15"
    others = [
        f"{field} at n = {n}: h̃ = {h:g}, there "
        f"{percent(1.0 - grids[field].at[h, n] / grids[field].at[1.3, n])} below that at 1.3"
        for field, best in lowest.items()
        for n, h in best.items()
        if h != 1.3
    ]
    cause = f"lower at another h̃: {because(*others)}"
    return finding(fall == 40 and right == 15, fall == 40 and 2 * right > 15, numbers, cause)


@claim(
    "D4",
    "Mode II: σxx and σyy lose their antisymmetry in y near the tip.",
    "sections 4.4 and 5.3, figures 4.15a, b",
    reproduced="at (60, 1.7) in the rows beside y = 0, up to 25 mm ahead of the tip, the even "
    f"part of σxx and that of σyy are at least {percent(UNEQUAL)} of the odd part (rms)",
    partly="that of one of the two is",
    otherwise="that of neither is",
)
def antisymmetry(results: Results) -> Finding:
    """Parity defects ahead of the tip, and what becomes of them without load or artificial stress."""
    grids = {
        name: whole_grid(results, f"stress_{name}_parity_defect_ahead", CRACK) for name in ("xx", "yy")
    }
    seen = [float(grid.at[DRAWN["h"], DRAWN["n"]]) >= UNEQUAL for grid in grids.values()]
    numbers = "; ".join(
        f"σ{name} {percent(grid.at[DRAWN['h'], DRAWN['n']])} "
        f"(all cells {percent(grid.min(axis=None))} to {percent(grid.max(axis=None))})"
        for name, grid in grids.items()
    )
    return finding(all(seen), any(seen), because(numbers, _what_breaks_it(results)))


def _what_breaks_it(results: Results) -> str:
    """In words: the defects at (40, 1.7) by load and artificial stress. Empty if they are not stored."""
    numbers = []
    for load, words in ((35.8e3, "full load"), (35.8, "a thousandth of the load")):
        for stress, how in ((0.3, "with"), (0.0, "without")):
            settings = {"h": 1.7, "scene.K": load, "method.artificial_stress": stress}
            found = [
                elsewhere(results, "conjectures", "mode2", settings, f"stress_{name}_parity_defect_ahead")
                for name in ("xx", "yy")
            ]
            values = [percent(value) for value in found if value is not None]
            if len(values) == 2:
                numbers.append(f"{words}, {how} artificial stress {' and '.join(values)}")
    return f"σxx and σyy at (40, 1.7): {'; '.join(numbers)}" if numbers else ""
