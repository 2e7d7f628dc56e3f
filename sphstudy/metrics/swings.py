"""Period and amplitude of a swinging tip without a model of its motion: crossings and peaks.

A fitted sine has one frequency and one decay rate; a plate that swings far, or that a quadratic viscosity
slows down, has neither.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import xarray as xr

from sphstudy.metrics.metric import Metric, pure

EDGE = 4
"""Swings (two periods) whose mean amplitude stands for the beginning or the end of a long run."""


class Swings(NamedTuple):
    """crossings [K]: times at which the displacement changes sign (s), a start from rest position
    included; peaks [K - 1]: its largest magnitude between one and the next (m).
    """

    crossings: np.ndarray
    peaks: np.ndarray


def swings(time: np.ndarray, displacement: np.ndarray) -> Swings:
    """Crossings, linear between samples, and peaks, by the parabola through the three largest samples.

    Parameters
    ----------
    time, displacement : array [M]
        Samples (s), (m).
    """
    time, displacement = np.asarray(time, float), np.asarray(displacement, float)
    # A stage's end is sampled twice.
    fresh = np.concatenate(([True], np.diff(time) > 0.0))
    time, displacement = time[fresh], displacement[fresh]
    below = np.signbit(displacement)
    before = np.flatnonzero(below[1:] != below[:-1])
    share = displacement[before] / (displacement[before] - displacement[before + 1])
    crossings = time[before] + share * (time[before + 1] - time[before])
    first = before + 1
    if displacement[0] == 0.0 and not (crossings.size and crossings[0] == time[0]):
        crossings, first = np.append(time[0], crossings), np.append(0, first)
    peaks = [_peak(np.abs(displacement), a, b) for a, b in pairwise(first.tolist())]
    return Swings(crossings, np.array(peaks))


def _peak(size: np.ndarray, begin: int, end: int) -> float:
    """Largest of size[begin:end], with the parabola through it and the samples beside it."""
    k = begin + int(np.argmax(size[begin:end]))
    left, middle, right = size[max(k - 1, 0)], size[k], size[min(k + 1, size.size - 1)]
    curvature = left - 2.0 * middle + right
    return float(middle - (right - left) ** 2 / (8.0 * curvature) if curvature < 0.0 else middle)


def period(found: Swings) -> float:
    """Mean period (s): twice the slope of a line through all crossings; NaN without a whole period."""
    if found.crossings.size < 3:
        return np.nan
    return 2.0 * float(np.polyfit(np.arange(found.crossings.size), found.crossings, 1)[0])


def loss_per_period(peaks: np.ndarray) -> float:
    """Share of the amplitude lost in a period, in the geometric mean from the first few peaks [K] (m)
    to the last few; negative where amplitudes grow. NaN for fewer than two.
    """
    few = min(EDGE, peaks.size // 2)
    if few == 0:
        return np.nan
    gained = float(np.mean(np.log(peaks[-few:])) - np.mean(np.log(peaks[:few])))
    return 1.0 - float(np.exp(2.0 * gained / (peaks.size - few)))


def measure(run: xr.Dataset, config) -> dict[str, Metric]:
    """Period and amplitudes of the tracked particle's u_y; of modes, nothing."""
    if not run.sizes.get("sample"):
        return {}
    found = swings(run["history_time"].values, run["history_u_y"].values)
    remark = "" if found.peaks.size > 1 else "the tip swings less than once to each side"
    first, last = (found.peaks[0], found.peaks[-1]) if found.peaks.size else (np.nan, np.nan)
    return {
        "period": Metric(period(found), "s", "mean period, from the tip's passages through rest", remark),
        "amplitude_first": Metric(first, "m", "largest |u_y| of the tip in its first swing"),
        "amplitude_last": Metric(last, "m", "largest |u_y| of the tip in its last whole swing"),
        "amplitude_loss_per_period": pure(
            loss_per_period(found.peaks), "share of the tip's amplitude lost per period, mean", remark
        ),
    }
