"""The dataset of `sphstudy speed` as tables on the terminal."""

import numpy as np
import xarray as xr

from sphstudy.benchmarks.speed.terms import term_costs
from sphstudy.benchmarks.tables import table
from sphstudy.console import print_table
from sphstudy.table import Cell, Column, Table
from sphstudy.text import number

_RATES = (
    "particles",
    "pairs",
    "pair_time",
    "directed_pair_time",
    "interacting_pair_time",
    "particle_steps",
    "step_time_spread",
)
_TIMES = ("load_time", "first_step_time", "start_compile_time", "peak_memory")
_BOUNDS = ("bound_measured", "bound_value", "bound_units", "bound_ratio", "bound_remark")
_PARTS = ("part_cpu_time", "part_compile_time", "part_wall_time")
_TERMS = ("method", "term", "with", "off", "never there", "cost", "off / never there")


def print_tables(found: xr.Dataset) -> None:
    """Prints what the dataset has: medians, CPU time unless a table says otherwise."""
    print(f"{found.attrs['processor']} ({found.attrs['processor_kind']}), {found.attrs['date_created']}")
    if "rate" in found.dims:
        for group in dict.fromkeys(found["rate_group"].values):
            chosen = found.isel(rate=np.flatnonzero(found["rate_group"].values == group))
            print_table(table(f"{group}: times per pair and evaluation", chosen, "rate", _RATES))
        print_table(_terms(found))
    for caption, dimension, names in (
        ("largest time per pair over smallest, over sizes", "flat", ("flatness",)),
        ("wall time with one worker over two workers'", "scaling", ("speedup", "control_speedup")),
        ("new processes until their first step", "start", ("start_particles", "start_cold", *_TIMES)),
        ("whole runs", "run", ("run_outcome", "run_time")),
        (f"measured beside {found.attrs['bound_source']}", "bound", _BOUNDS),
        ("cost of these measurements", "part", _PARTS),
    ):
        print_table(table(caption, found, dimension, names))
    if found.attrs["remarks"]:
        print(found.attrs["remarks"])


def _terms(found: xr.Dataset) -> Table:
    """What each term costs, and how far switching it off gets to a method that never had it."""
    columns = [Column(title, numeric=k > 1) for k, title in enumerate(_TERMS)]
    rows = []
    for one in term_costs(found):
        times = (one.full.median, one.off.median, one.never.median, one.cost, one.left)
        rows.append([Cell(one.method), Cell(one.term), *(Cell(number(time)) for time in times)])
    return Table("terms: ns per unordered pair", columns, rows)
