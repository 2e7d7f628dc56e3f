"""A run and its bounds: done, degraded or diverged; if not done, when, and which indicator says so."""

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr

from sphstudy.analysis.stability import indicators
from sphstudy.analysis.stability.bounds import Bound
from sphstudy.store.record import STATUS

DONE, DEGRADED, DIVERGED = "done", "degraded", "diverged"


@dataclass(frozen=True)
class Breach:
    """A bound that a run breaks.

    time: of the first sample outside (s); of a metric, the end of the run. value: the one farthest
    outside; NaN if the run lacks the metric.
    """

    bound: Bound
    time: float
    value: float


@dataclass(frozen=True)
class Judgement:
    """outcome: "done" inside all bounds, "degraded" outside one, else the status of the record.

    breaches: earliest first. end: time of the last sample (s), NaN if there is none. message: the
    record's. unjudged: bounds of quantities that the record lacks.
    """

    outcome: str
    breaches: tuple[Breach, ...]
    end: float
    message: str
    unjudged: tuple[Bound, ...] = ()

    @property
    def time(self) -> float:
        """When it first broke a bound, or diverged (s); NaN if it is done."""
        if self.breaches:
            return self.breaches[0].time
        return self.end if self.outcome == DIVERGED else math.nan


def judge(run: xr.Dataset | None, bounds: list[Bound]) -> Judgement:
    """Judges a run.

    Parameters
    ----------
    run : xarray.Dataset or None
        Its record; None if it is not stored.
    bounds : list of Bound
        Those of its point.
    """
    status = "missing" if run is None else STATUS[int(run["status"])]
    if run is None or status not in (DONE, DIVERGED):
        return Judgement(status, (), math.nan, "" if run is None else run.attrs["message"])
    times = run["history_time"].values
    end = float(times[-1]) if times.size else math.nan
    breaches, unjudged = [], []
    for bound in bounds:
        values, when = _values(run, bound, times)
        if values is None:
            unjudged.append(bound)
        elif (outside := bound.excess(values) > 0.0).any():
            worst = int(np.nanargmax(bound.excess(values)))
            breaches.append(Breach(bound, float(when[outside.argmax()]), float(values[worst])))
        elif not bound.indicator and np.isnan(values[0]):
            breaches.append(Breach(bound, end, math.nan))
    breaches.sort(key=lambda breach: breach.time)
    outcome = DEGRADED if status == DONE and breaches else status
    return Judgement(outcome, tuple(breaches), end, run.attrs["message"], tuple(unjudged))


def _values(run: xr.Dataset, bound: Bound, times: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
    """The values of a bound's quantity, None if the record has none; and their times (s)."""
    if bound.indicator:
        values = indicators.measure(run, bound.indicator) if times.size else np.empty(0)
        return (None, times) if np.isnan(values).all() else (values, times)
    if bound.quantity not in run or run[bound.quantity].attrs.get("group") != "metric":
        return None, times
    return np.array([float(run[bound.quantity])]), times[-1:] if times.size else np.array([math.nan])
