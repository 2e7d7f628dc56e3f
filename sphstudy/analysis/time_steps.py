"""Time steps: how long stable ones are, and which are worth taking, from points already computed."""

import numpy as np
import pandas as pd

from sphstudy.analysis.work_precision import ERRORS
from sphstudy.catalogue import method_module

SCHEME = ["method", "integrator", "damped"]
"""What the limit of a body depends on beside h and ν: method, integrator, whether there is viscosity."""

HARMLESS = 0.1
"""Of the error that a result has anyway: what a time step may change it by and still be worth taking."""


def limits(table: pd.DataFrame) -> pd.DataFrame:
    """The searches for the largest stable step in a study's table, a row each, every record once.

    Columns: SCHEME, `h`, `n`, `nu`, `found` (largest stable C), `predicted` (C of 2/ω_max), `lowest` (the
    smallest C tried), `message`; found and predicted NaN where there is none.
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
    """What the time step does to the error of a scene's runs, a row a run, by SCHEME, h and time step.

    Columns: SCHEME, `h`, `courant` (C of the step), `share` (of the largest stable one), `change` (of the
    error against that with the shortest step, over the size of the latter; NaN unless the run is done),
    `error` (that of the shortest step), `status`. Runs with no limit found in the table for their scheme,
    h, n and ν are left out.
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
    """For each scheme and h of `changes` the longest step worth taking: it is stable, and none up to it
    changes the error by HARMLESS or more. A run may end before a step that is too long has done its harm.
    """
    best = []
    for _, chosen in found.groupby([*SCHEME, "h"]):
        good = ((chosen["change"] < HARMLESS) & (chosen["share"] <= 1.0)).to_numpy()
        # A step that happens to be good beyond one that is not is not to be relied on.
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
