"""What the thesis suspects behind its failures (5.1 to 5.3), tested by runs that could refute it.

A particle method is unstable in tension where W'' > 0 at the nearest neighbour and in compression where
W'' < 0 (Swegle, Hicks & Attaway 1995), and the instability feeds on stress: it must follow the sign of
W'' from kernel to kernel, and go away with the load.
"""

from collections.abc import Iterable

import numpy as np
import pandas as pd

from sphstudy.analysis.claims.claim import Finding, claim
from sphstudy.analysis.claims.reading import because, finding
from sphstudy.analysis.claims.tensile_instability import (
    FULL,
    INFLECTION,
    THOUSANDTH,
    curvature_at_neighbour,
    unstable_side,
)
from sphstudy.analysis.results import Missing, Results
from sphstudy.metrics.roughness import VISIBLE
from sphstudy.text import number, percent

KERNEL, STRESS = "method.kernel", "method.artificial_stress"


def _points(results: Results, block: str, metrics: list[str]) -> pd.DataFrame:
    """All points of a block. Raises Missing if one lacks a metric."""
    points = results.select(block=block)
    if points.empty or any(m not in points or points[m].isna().any() for m in metrics):
        raise Missing(f"{results.name}: block {block} is not complete")
    return points


def _by_sign(points: pd.DataFrame, measure: pd.Series) -> tuple[pd.Series, pd.Series]:
    """The measure where W'' at the nearest neighbour is positive, and where it is negative."""
    curvature = np.array(
        [curvature_at_neighbour(h, k) for h, k in zip(points["h"], points[KERNEL], strict=True)]
    )
    return measure[curvature > INFLECTION], measure[curvature < -INFLECTION]


def _listed(points: pd.DataFrame, measure: pd.Series) -> str:
    return ", ".join(
        f"{kernel} {h:g}: {number(value, 3)}"
        for kernel, h, value in zip(points[KERNEL], points["h"], measure, strict=True)
    )


@claim(
    "K1",
    "The spikes at h̃ = 1.3 below the axis of the vibrating plate, its tensile side at a quarter "
    "period, are due to tensile instability.",
    "section 5.1 (suspected)",
    reproduced="they are there at full load and not at a thousandth of it, and the roughness below the "
    "axis grows more with the load for every kernel and h̃ with W'' > 0 at the nearest neighbour than for "
    "any with W'' < 0",
    partly="the first",
    otherwise="they do not go away with the load",
)
def spikes(results: Results) -> Finding:
    """Roughness below the axis, with kernels of either sign of W'', at full load and a thousandth."""
    metric = "stress_roughness_bottom"
    points = _points(results, "plate", [metric])
    points = points[points[STRESS] == 0.0].sort_values([KERNEL, "h"])
    full, little = (points[points["scene.H0"] == load].reset_index() for load in (FULL, THOUSANDTH))
    growth = full[metric] / little[metric]
    tensile, compressive = _by_sign(full, growth)
    thesis = (full[KERNEL] == "cubic") & (full["h"] == 1.3)
    loaded, unloaded = (float(case.loc[thesis, metric].iloc[0]) for case in (full, little))
    stress_driven = loaded >= VISIBLE > unloaded
    follows = tensile.min() > compressive.max()
    numbers = (
        f"roughness of the cubic spline at 1.3: {percent(loaded)} at full load, {percent(unloaded)} at a "
        f"thousandth; growth with the load (kernel, h̃): {_listed(full, growth)}; at least "
        f"{number(tensile.min(), 3)} where W'' > 0, at most {number(compressive.max(), 3)} where W'' < 0"
    )
    cause = "" if follows else "the growth does not follow the sign of W'' alone"
    return finding(stress_driven and follows, stress_driven, numbers, cause)


@claim(
    "K2",
    "That particles clump below the axis of the bent plate, its compressed side, is due to tensile "
    "instability.",
    "section 5.2 (suspected, and found unexpected there)",
    reproduced="at h̃ = 1.7 the spread of distances grows more below than above and hardly at a "
    "thousandth of the load (by less than a tenth of that), and the ratio of the spreads below and above "
    "is larger for every kernel and h̃ with W'' < 0 at the nearest neighbour, unstable in compression, "
    "than for any with W'' > 0",
    partly="it grows more below, and either goes with the load or follows the sign of W''",
    otherwise="not even that",
)
def clumping(results: Results) -> Finding:
    """Spread of nearest-neighbour distances at the end over that at 11 s, below and above the axis."""
    metrics = [f"spacing_spread_{side}{when}" for side in ("bottom", "top") for when in ("", "_11s")]
    points = _points(results, "bending_kernel", metrics).reset_index()
    little = _points(results, "bending_load", metrics).iloc[0]
    ratio = points["spacing_spread_bottom"] / points["spacing_spread_top"]
    tensile, compressive = _by_sign(points, ratio)
    case = points[(points[KERNEL] == "cubic") & (points["h"] == 1.7)].iloc[0]
    grown = {side: _growth(case, side) for side in ("bottom", "top")}
    unloaded = _growth(little, "bottom")
    below = grown["bottom"] > max(grown["top"], 1.0)
    stress_driven = unloaded - 1.0 < 0.1 * (grown["bottom"] - 1.0)
    follows = compressive.min() > tensile.max()
    numbers = (
        f"n = {case['n']}, cubic spline at 1.7, spread at the end over that at 11 s: "
        f"{number(grown['bottom'], 3)} below, {number(grown['top'], 3)} above, {number(unloaded, 3)} "
        f"below at a thousandth of the load (to {percent(case['spacing_spread_bottom'])} and "
        f"{percent(little['spacing_spread_bottom'])}); below over above (kernel, h̃): "
        f"{_listed(points, ratio)}"
    )
    reasons = [unstable_side(1.7)] if follows else ["the spreads do not follow the sign of W''"]
    if not stress_driven:
        reasons.append("irregularity grows without load too, if less")
    everything = below and stress_driven and follows
    return finding(everything, below and (stress_driven or follows), numbers, because(*reasons))


def _growth(point: pd.Series, side: str) -> float:
    return float(point[f"spacing_spread_{side}"] / point[f"spacing_spread_{side}_11s"])


@claim(
    "K3",
    "Mode II loses its antisymmetry because of tensile instability, or because artificial stress acts on "
    "the tensile side only.",
    "section 5.3 (suspected)",
    reproduced="for σ_xx and σ_yy, the defects ahead of the tip are without artificial stress at most "
    "half as large at each h̃, or at h̃ = 1.3 (W'' > 0) at least twice as large as at 1.5 (W'' = 0)",
    partly="for one of the two stresses, or at one h̃",
    otherwise="nowhere: something else breaks the antisymmetry",
)
def antisymmetry(results: Results) -> Finding:
    """Parity defects ahead of the tip, with and without artificial stress, at full load and at 1/1000."""
    metrics = {stress: f"stress_{stress}_parity_defect_ahead" for stress in ("xx", "yy")}
    points = _points(results, "mode2", list(metrics.values()))
    full, little = points["scene.K"].max(), points["scene.K"].min()
    numbers, whole, somewhere = [], [], []
    for stress, metric in metrics.items():
        defects = points.pivot(index="h", columns=["scene.K", STRESS], values=metric)
        on, off = defects[full, points[STRESS].max()], defects[full, 0.0]
        unloaded = [defects[little, stress_on].mean() for stress_on in (on.name[1], off.name[1])]
        artificial = off <= 0.5 * on
        tensile = bool(off[1.3] >= 2.0 * off[1.5])
        whole.append(bool(artificial.all()) or tensile)
        somewhere.append(bool(artificial.any()) or tensile)
        numbers.append(
            f"σ_{stress} at h̃ = {', '.join(f'{h:g}' for h in on.index)}: {_row(on)} with artificial "
            f"stress, {_row(off)} without; at a thousandth of the load on average {_row(unloaded)}"
        )
    cause = (
        "likely: displacements near the tip are not small against the spacing, the faces slide past each "
        "other, and pairs see each other round the tip on one side that do not on the other; the "
        "averages at a thousandth of the load say how much of the defects goes with the displacements"
    )
    return finding(all(whole), any(somewhere), "; ".join(numbers), cause)


def _row(values: Iterable[float]) -> str:
    return ", ".join(percent(value) for value in values)
