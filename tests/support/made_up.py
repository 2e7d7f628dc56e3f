"""Runs made up in no time: what stands in for the solver where a test is about what is around it."""

import numpy as np
import xarray as xr

from sphstudy.configuration.composition import session
from sphstudy.running import one_run
from tests.support.records import record

TINY = ("scene=plate", "method=tl", "h=1.3", "scene.periods=0.01")
"""Where such a run is computed after all, it takes a hundredth of a second."""


def points(*arguments):
    """The points of TINY and these overrides."""
    with session() as hydra:
        return hydra.points([*TINY, *arguments], sweep=True)[0]


def solved(config, *_):
    """A record that is done, without a solver."""
    cost = dict.fromkeys(("cpu_seconds", "steps", "particles"), (1.0, "1"))
    fields = xr.Dataset({"x": ("particle", np.random.default_rng(config.n).random(4000))})
    return record(config, metrics={"error": 0.1}, cost=cost, fields=fields)


class Solver:
    """Stands in for the solver; counts its runs, by n, and does what `deeds` has for that n before."""

    def __init__(self, monkeypatch):
        self.runs, self.deeds = [], {}
        monkeypatch.setattr(one_run, "_solved", self)

    def __call__(self, config, *rest):
        self.runs.append(config.n)
        if deed := self.deeds.get(config.n):
            deed(config, *rest)
        return solved(config)
