"""What each term of a method costs, from the dataset of `sphstudy speed`."""

from typing import NamedTuple

import numpy as np
import xarray as xr


class Time(NamedTuple):
    """CPU time per pair and evaluation [ns]: median of the rounds, and their quartiles."""

    median: float
    lower: float
    upper: float


class TermCost(NamedTuple):
    """A method with all its terms, with one switched off, and with a model that never had that one."""

    method: str
    term: str
    full: Time
    off: Time
    never: Time

    @property
    def cost(self) -> float:
        """Cost of the term over a model that never had it [ns]."""
        return self.full.median - self.never.median

    @property
    def left(self) -> float:
        """Time with the term switched off over that without it: 1 if nothing of its cost is left."""
        return self.off.median / self.never.median


def term_costs(found: xr.Dataset) -> list[TermCost]:
    """Every term of every method that was timed.

    All times are per pair that the full method holds, so that they compare as steps do: a crack hides
    some pairs.
    """
    chosen = found.isel(rate=np.flatnonzero(found["rate_group"].values == "terms"))
    keys = zip(*(chosen[f"rate_{key}"].values for key in ("method", "term", "variant")), strict=True)
    rows = {key: chosen.isel(rate=k) for k, key in enumerate(keys)}
    costs = []
    for method, term, variant in rows:
        if variant == "off":
            full = rows[method, "", "all"]
            scale = float(full["pair_time"] / full["step_time"])
            three = (full, rows[method, term, "off"], rows[method, term, "never"])
            costs.append(TermCost(str(method), str(term), *(_time(one, scale) for one in three)))
    return costs


def _time(one: xr.Dataset, scale: float) -> Time:
    lower, upper = np.nanquantile(one["step_times"].values, (0.25, 0.75))
    return Time(scale * float(one["step_time"]), scale * float(lower), scale * float(upper))
