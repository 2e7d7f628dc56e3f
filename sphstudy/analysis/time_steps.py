"""Time steps: how long stable ones are, and which are worth taking, from stored points."""

import numpy as np
import pandas as pd

from sphstudy.analysis.work_precision import ERRORS
from sphstudy.catalogue import method_module

SCHEME = ["method", "integrator", "damped"]
"""The limit of a body depends on these, h and ν: method, integrator, whether there is viscosity."""

HARMLESS = 0.1
"""A time step is worth taking if it changes the error of a result by less than this share of it."""


def limits(table: pd.DataFrame) -> pd.DataFrame:
    """The searches for the largest stable step.

    Parameters
    ----------
    table : pandas.DataFrame
        Table of a study's `Results`.

    Returns
    -------
    pandas.DataFrame
        A row for each record: SCHEME, `h`, `n`, `nu`, `found` (largest stable C), `predicted` (C of
        2/ω_max; both NaN without a value), `lowest` (smallest C tried), `message`.
    """
    rows = _of_solver(table, "limit")
    if rows.empty:
        return pd.DataFrame(columns=[*SCHEME, "h", "n", "nu", "found", "predicted", "lowest", "message"])
    return pd.DataFrame(
        {
            **_scheme(rows),
            "h": rows["h"],
            "n": rows["n"],
            "nu": rows["scene.nu"],
            "found": rows["largest_stable_courant"],
            "predicted": rows["predicted_courant"],
            "lowest": rows["solve.lowest_courant"],
            "message": rows["message"],
        }
    )


def changes(table: pd.DataFrame, scene: str = "plate") -> pd.DataFrame:
    """The change of the error by the time step.

    Parameters
    ----------
    table : pandas.DataFrame
        Table of a study's `Results`.
    scene : str
        Whose runs.

    Returns
    -------
    pandas.DataFrame
        A row for each run whose limit the table has: SCHEME, `h`, `courant` (C of the step), `share` (of
        the largest stable step), `change` (of the error against the shortest step, relative to it; NaN
        unless the run is done), `error` (with the shortest step), `status`.
    """
    known = limits(table).set_index([*SCHEME, "h", "n", "nu"])
    known = known[~known.index.duplicated()]
    rows = _of_solver(table[table["scene"] == scene], "explicit")
    kept = []
    if not rows.empty:
        rows = rows.assign(**_scheme(rows))
        for place, chosen in rows.groupby([*SCHEME, "h", "n", "scene.nu"]):
            if place in known.index and np.isfinite(known.at[place, "found"]):
                limit = known.loc[place]
                courant = chosen["solve.courant"].where(
                    chosen["solve.time_step"] == "courant", chosen["solve.safety"] * limit["predicted"]
                )
                chosen = chosen.assign(courant=courant, share=courant / limit["found"])
                kept.append(_against_shortest(chosen.sort_values("courant"), ERRORS[scene]))
    columns = [*SCHEME, "h", "courant", "share", "change", "error", "status"]
    return pd.concat(kept)[columns] if kept else pd.DataFrame(columns=columns)


def _against_shortest(chosen: pd.DataFrame, metric: str) -> pd.DataFrame:
    error = chosen[metric].where(chosen["status"] == "done")
    shortest = error.iloc[0]
    return chosen.assign(error=shortest, change=(error - shortest).abs() / abs(shortest))


def worth(found: pd.DataFrame) -> pd.DataFrame:
    """For each scheme and h the longest step worth taking: stable, and no step up to it changes the error
    by HARMLESS or more.

    Parameters
    ----------
    found : pandas.DataFrame
        What `changes` gives.
    """
    best = []
    for _, chosen in found.groupby([*SCHEME, "h"]):
        # Stable too: a run may end before a step that is too long has done its harm.
        good = ((chosen["change"] < HARMLESS) & (chosen["share"] <= 1.0)).to_numpy()
        # A good step beyond a bad one is luck.
        count = int(np.argmin(good)) if not good.all() else good.size
        if count:
            best.append(chosen.iloc[[count - 1]])
    return pd.concat(best) if best else found.iloc[:0]


def _of_solver(table: pd.DataFrame, solver: str) -> pd.DataFrame:
    rows = table[(table["solve"] == solver) & table["status"].isin(("done", "diverged"))]
    return rows.drop_duplicates("record")


def _scheme(rows: pd.DataFrame) -> dict[str, object]:
    own = {kind: method_module(kind).INTEGRATORS[0] for kind in rows["method.kind"].unique()}
    asked = rows["solve.integrator"]
    viscosity = rows["method.viscosity_linear"] + rows["method.viscosity_quadratic"]
    return {
        "method": rows["method"],
        "integrator": asked.where(asked != "auto", rows["method.kind"].map(own)),
        "damped": viscosity > 0.0,
    }
