"""Tables of time steps: the largest stable ones, and the longest that hardly change the error."""

import numpy as np
import pandas as pd

from sphstudy import text
from sphstudy.analysis import time_steps
from sphstudy.analysis.results import Results
from sphstudy.analysis.time_steps import SCHEME
from sphstudy.table import Cell, Column, Table


def tables(results: Results) -> list[Table]:
    """Both tables of the study's own points; none where it has no limits."""
    own = results.table[results.table["study"] == results.name]
    found = time_steps.limits(own)
    if found.empty:
        return []
    best = time_steps.worth(time_steps.changes(own))
    return [_limits(found)] + ([_worth(best)] if len(best) else [])


def _limits(found: pd.DataFrame) -> Table:
    radii = sorted(found["h"].unique())
    columns = [
        *_SCHEME_COLUMNS,
        Column("ν"),
        Column("n"),
        *(Column(f"h={h:g}", "largest stable C, and its ratio to that of 2/ω_max") for h in radii),
    ]
    rows = []
    for place, chosen in found.groupby([*SCHEME, "nu", "n"], sort=False):
        by_radius = chosen.set_index("h")
        *scheme, nu, n = place
        cells = [_limit(by_radius.loc[h]) if h in by_radius.index else Cell("") for h in radii]
        rows.append([*_scheme(scheme), Cell(f"{nu:g}", nu), Cell(str(n), n), *cells])
    return Table("Largest stable time step, C of Δt = C Δ/c0 (over 2/ω_max)", columns, rows)


def _limit(row: pd.Series) -> Cell:
    if np.isnan(row["found"]):
        return Cell(row["message"])
    ratio = row["found"] / row["predicted"]
    beside = f" ({text.number(ratio, 4)})" if np.isfinite(ratio) else ""
    return Cell(text.number(row["found"], 4) + beside, row["found"])


def _worth(best: pd.DataFrame) -> Table:
    columns = [
        *_SCHEME_COLUMNS,
        Column("h"),
        Column("C worth taking", "the longest step tried that changes the error by less than a tenth"),
        Column("over the largest stable"),
        Column("changes the error by (%)", "relatively, against the shortest step"),
        Column("error (%)", "with the shortest step"),
    ]
    rows = [
        [
            *_scheme(row[SCHEME]),
            Cell(f"{row['h']:g}", row["h"]),
            *(Cell(text.number(value, 3), value) for value in (row["courant"], row["share"])),
            *(Cell(text.number(100.0 * row[name], 3), row[name]) for name in ("change", "error")),
        ]
        for _, row in best.iterrows()
    ]
    return Table("The time step that is worth taking", columns, rows)


_SCHEME_COLUMNS = [Column(name, numeric=False) for name in ("method", "integrator", "viscosity")]


def _scheme(scheme) -> list[Cell]:
    method, integrator, damped = scheme
    return [Cell(method), Cell(integrator), Cell("yes" if damped else "no")]
