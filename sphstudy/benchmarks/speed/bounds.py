"""Bounds of the measurements (bounds.yaml), and the measurements beside them."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from sphstudy.benchmarks.speed.bodies import PERTURBED
from sphstudy.benchmarks.speed.measurements import Measurements
from sphstudy.parameters import described, number, parameters

SOURCE = "what must hold for the project's speed: one Zen 4 core, float64, CPU time, medians"


@parameters
class Bound:
    """A limit of a measured quantity."""

    quantity: str = described("which: pair_time, directed_pair_time, flatness, run_seconds or speedup")
    value: float = number("the limit, in `units`", gt=0)
    units: str = described("UDUNITS")
    meaning: str = described("of what, under which circumstances")
    at_least: bool = described("whether it should be no smaller, not no larger")


@dataclass(frozen=True)
class Reached:
    """A measurement beside its bound. remark: what a reader needs besides to judge it."""

    label: str
    bound: Bound
    measured: float
    remark: str = ""

    @property
    def ratio(self) -> float:
        """Measured over bound."""
        return self.measured / self.bound.value


@cache
def bounds() -> dict[str, Bound]:
    """All bounds by name."""
    values: dict[str, dict[str, Any]] = yaml.safe_load(
        Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8")
    )
    return {name: Bound(**{"at_least": False, **bound}) for name, bound in values.items()}


def reached(found: Measurements) -> list[Reached]:
    """Every measurement that has a bound, in the order of bounds.yaml."""
    rows: list[tuple[str, Reached]] = []
    for rate in found.rates:
        if name := rate.case.bound:
            directed = bounds()[name].quantity == "directed_pair_time"
            time = rate.directed_pair_time if directed else rate.pair_time
            strict = time * rate.interacting_pair_time / rate.pair_time
            remark = f"{strict:.3g} ns if only pairs within the support count"
            rows.append((name, Reached(rate.case.label, bounds()[name], time, remark)))
    flat = flatness(found).get(("tl", PERTURBED))
    if flat is not None:
        rows.append(("tl flat", Reached("tl, perturbed", bounds()["tl flat"], flat)))
    for run in found.runs:
        rows.append((run.bound, Reached(run.label, bounds()[run.bound], run.median)))
    for one in found.scalings:
        control = f"control {one.control_speedup:.3g}"
        rows.append((one.bound, Reached(one.label, bounds()[one.bound], one.speedup, control)))
    order = list(bounds())
    return [row for _, row in sorted(rows, key=lambda row: order.index(row[0]))]


def flatness(found: Measurements) -> dict[tuple[str, str], float]:
    """Largest time per pair over the smallest among the sizes of each form (method, arrangement)."""
    forms: dict[tuple[str, str], list[float]] = {}
    for rate in found.rates:
        if rate.case.group == "growth":
            forms.setdefault((rate.method, rate.case.arrangement), []).append(rate.pair_time)
    return {form: max(times) / min(times) for form, times in forms.items()}
