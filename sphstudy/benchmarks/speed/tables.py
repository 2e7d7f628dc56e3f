"""The dataset of `study speed` as tables on the console."""

import numpy as np
import xarray as xr
from rich.box import SIMPLE_HEAD
from rich.table import Table

from sphstudy.benchmarks.speed.terms import term_costs
from sphstudy.console import console
from sphstudy.text import number

_RATES = {
    "particles": "particles",
    "pairs": "pairs",
    "pair_time": "ns per unordered pair",
    "directed_pair_time": "directed",
    "interacting_pair_time": "within support",
    "particle_steps": "particle-steps/s",
    "step_time_spread": "spread",
}
_SCALINGS = {"speedup": "speed-up", "control_speedup": "control"}
_STARTS = {
    "start_particles": "particles",
    "start_cold": "nothing compiled",
    "load_time": "loaded (s)",
    "first_step_time": "first step (s)",
    "start_compile_time": "compiling (s)",
    "peak_memory": "peak memory (MB)",
}
_BOUNDS = {
    "bound_measured": "measured",
    "bound_value": "bound",
    "bound_units": "unit",
    "bound_ratio": "measured / bound",
    "bound_remark": "remark",
}
_PARTS = {"part_cpu_time": "CPU (s)", "part_compile_time": "compiling (s)", "part_wall_time": "wall (s)"}


def print_tables(found: xr.Dataset) -> None:
    """All tables that the dataset has: medians, CPU time unless it says otherwise."""
    print(f"{found.attrs['processor']} ({found.attrs['processor_kind']}), {found.attrs['date_created']}")
    if "rate" in found.dims:
        for group in dict.fromkeys(found["rate_group"].values):
            chosen = found.isel(rate=np.flatnonzero(found["rate_group"].values == group))
            _print(f"{group}: per pair and evaluation", chosen, "rate", _RATES)
        print_terms(found)
    _print("largest time per pair over smallest, over sizes", found, "flat", {"flatness": "ratio"})
    _print("one worker over two, wall time", found, "scaling", _SCALINGS)
    _print("new processes until their first step", found, "start", _STARTS)
    _print("whole runs", found, "run", {"run_outcome": "outcome", "run_time": "CPU (s)"})
    _print(f"measured beside {found.attrs['bound_source']}", found, "bound", _BOUNDS)
    _print("what this took", found, "part", _PARTS)
    if found.attrs["remarks"]:
        print(found.attrs["remarks"])


def print_terms(found: xr.Dataset) -> None:
    """What each term costs, and how far switching it off gets to a method that never had it."""
    costs = term_costs(found)
    if costs:
        headings = ("method", "term", "with", "off", "never there", "cost", "off / never there")
        table = Table(*headings, box=SIMPLE_HEAD, pad_edge=False, title="terms: ns per unordered pair")
        for one in costs:
            times = (one.full.median, one.off.median, one.never.median, one.cost, one.left)
            table.add_row(one.method, one.term, *(number(time) for time in times))
        console().print(table)


def _print(title: str, found: xr.Dataset, dimension: str, columns: dict[str, str]) -> None:
    if dimension not in found.dims:
        return
    table = Table(box=SIMPLE_HEAD, pad_edge=False, title=title, title_justify="left")
    table.add_column(dimension)
    for heading in columns.values():
        table.add_column(heading, justify="right")
    for k, label in enumerate(found[dimension].values):
        table.add_row(str(label), *(_shown(found[name].values[k]) for name in columns))
    console().print(table)


def _shown(value: object) -> str:
    if isinstance(value, str):
        return value
    return number(float(value))  # type: ignore[arg-type]
