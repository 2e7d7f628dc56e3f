"""What a solver leaves, whichever it is: states, history, how it ended, and what it has to say."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from sphstudy.numerics.solvers.indicators import Seen
from sphstudy.numerics.sph.invariants import Invariants

FIELDS = ("x", "y", "velocity_x", "velocity_y", "density", "stress_xx", "stress_yy", "stress_xy")
"""Rows of Snapshot.fields; the stress is Cauchy's."""

LAST_GOOD = "last good"
"""Label of the snapshot that a run that went bad keeps: its last sample at which all was well."""

HISTORY = ("time", "step", "u_x", "u_y", *Invariants._fields, *Seen._fields)
"""Columns of Solution.history."""


@dataclass
class Snapshot:
    """The body at the end of a stage or at a requested time.

    fields [8, N]: rows FIELDS. strain_energy (J/m). closure_work: ½ times the forces that the bonds cut
    at the stage's beginning transmitted, times the displacements now (J/m); NaN where nothing was cut.
    """

    label: str
    time: float
    step: int
    fields: np.ndarray
    strain_energy: float
    closure_work: float = np.nan


class Variable(NamedTuple):
    """Something that only this kind of solver knows, as a record keeps it.

    dims: () for a number, which tables show, or names, "particle" among them.
    """

    dims: tuple[str, ...]
    values: Any
    units: str
    long_name: str


@dataclass
class Solution:
    """Everything a run leaves: snapshots, sampled history, how it ended.

    outcome: "done" or "diverged", which `message` explains. steps: time steps, or linear systems solved.
    """

    snapshots: list[Snapshot] = field(default_factory=list)
    history: list[tuple[float, ...]] = field(default_factory=list)
    stage_steps: dict[str, int] = field(default_factory=dict)
    outcome: str = "done"
    message: str = ""
    steps: int = 0
    pairs: int = 0
    time_step: float = 0.0
    variables: dict[str, Variable] = field(default_factory=dict)
