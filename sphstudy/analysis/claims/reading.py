"""What rules read from results: the thesis's grids, their shapes, and numbers in words."""

from typing import Any

import pandas as pd

from sphstudy.analysis.claims.claim import NOT, PARTLY, REPRODUCED, Finding
from sphstudy.analysis.effects import CONTROL
from sphstudy.analysis.results import Missing, Results
from sphstudy.text import percent

SMOOTHING = (1.3, 1.5, 1.7, 1.9)
"""Relative smoothing radii h̃ of every grid of the thesis."""

PLATE, CRACK = (9, 15, 21), (40, 50, 60)
"""Resolutions of its grids: rows of the plate, columns of the square."""


def whole_grid(results: Results, metric: str, resolutions: tuple[int, ...]) -> pd.DataFrame:
    """A metric in the cells of the thesis's grid.

    Parameters
    ----------
    results : Results
        A study with that grid.
    metric : str
        Name of the metric.
    resolutions : tuple of int
        PLATE or CRACK.

    Returns
    -------
    pandas.DataFrame
        h (index) by n (columns). Missing is raised, and names the cells, if any has no value.
    """
    grid = results.grid(metric).reindex(index=list(SMOOTHING), columns=list(resolutions))
    if grid.isna().any(axis=None):
        raise Missing(f"{results.name}: no {metric} at (n, h̃) = {cells(grid.isna())}")
    return grid


def unstable(results: Results, grid: pd.DataFrame) -> pd.DataFrame:
    """The cells of a grid, as a mask, that the study calls unstable."""
    marks = [entry.holds for entry in results.definition.unstable]
    flags = [[any(holds({"h": h, "n": n}) for holds in marks) for n in grid.columns] for h in grid.index]
    return pd.DataFrame(flags, index=grid.index, columns=grid.columns)


def falls(grid: pd.DataFrame) -> pd.DataFrame:
    """Whether the size falls to each n from the one before: h (index) by n but the first (columns)."""
    return grid.abs().diff(axis=1).iloc[:, 1:] < 0.0


def best_smoothing(grid: pd.DataFrame) -> pd.Series:
    """For each n the h̃ where the size is smallest."""
    return grid.abs().idxmin()


def finding(everything: bool, core: bool, numbers: str, cause: str = "") -> Finding:
    """The finding of a rule.

    Parameters
    ----------
    everything, core : bool
        Whether all of the claim holds (REPRODUCED), or its core at least (PARTLY; else NOT).
    numbers, cause : str
        As in Finding; what is reproduced needs no cause.
    """
    if everything:
        return Finding(REPRODUCED, numbers)
    return Finding(PARTLY if core else NOT, numbers, cause)


def within(grid: pd.DataFrame, lower: float, upper: float) -> pd.DataFrame:
    """The cells, as a mask, whose values lie in a range."""
    return (grid >= lower) & (grid <= upper)


def count(mask: pd.DataFrame) -> int:
    """How many cells of a mask are set."""
    return int(mask.to_numpy().sum())


def everywhere(mask: pd.DataFrame) -> bool:
    """Whether all cells of a mask are set."""
    return bool(mask.to_numpy().all())


def cells(mask: pd.DataFrame) -> str:
    """The cells that are set in a mask, as the thesis writes them: (n, h̃)."""
    return ", ".join(f"({n}, {h:g})" for n in mask.columns for h in mask.index if mask.at[h, n])


def signed(value: float) -> str:
    """A share in per cent, with its sign."""
    return percent(value, sign=True)


def span(grid: pd.DataFrame) -> str:
    """Smallest and largest value of a grid of shares."""
    return f"{signed(grid.min(axis=None))} to {signed(grid.max(axis=None))}"


def interval(limits: tuple[float, float], scale: float = 1.0) -> str:
    """A range in words, scaled; with signs if it begins below zero."""
    sign = "+" if limits[0] < 0.0 else ""
    return " to ".join(f"{scale * limit:{sign}.3g}" for limit in limits).replace("-", "−")


def choices(best: pd.Series) -> str:
    """The h̃ that is best for each n."""
    if best.nunique() == 1:
        return f"{best.iloc[0]:g} for each n"
    return ", ".join(f"{h:g} (n = {n})" for n, h in best.items())


def elsewhere(
    results: Results, study: str, block: str, settings: dict[str, Any], metric: str
) -> float | None:
    """A metric of the point of another study with these settings in a block; None if it is not stored."""
    try:
        return results.other(study).value(metric, settings, block)
    except Missing:
        return None


def options(results: Results, scene: str, metric: str) -> str:
    """In words: how far the choices that the thesis leaves open move a relative error, each on its own.

    Empty as long as one of them is not in the store.
    """
    points = results.other("choices").select(block=scene)
    if metric not in points or (points["status"] == "missing").any():
        return ""
    changed = points["varied"].ne("") & ~points["varied"].str.startswith(CONTROL)
    known, first = points[changed & points[metric].notna()], points.iloc[0]
    least, most = known.loc[known[metric].idxmin()], known.loc[known[metric].idxmax()]
    return (
        f"each alone, the choices left open give {signed(least[metric])} ({least['varied']}) to "
        f"{signed(most[metric])} ({most['varied']}) at ({first['n']}, {first['h']:g})"
    )


def because(*reasons: str) -> str:
    """The reasons that there are, in one sentence."""
    return "; ".join(filter(None, reasons))
