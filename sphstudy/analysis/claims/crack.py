"""What the claims about both modes of the crack read: norms of the five fields, and frozen visibility."""

import pandas as pd

from sphstudy.analysis.claims.reading import CRACK, option, percent, whole_grid
from sphstudy.analysis.results import Results

DISPLACEMENTS, STRESSES = ("u_x", "u_y"), ("stress_xx", "stress_yy", "stress_xy")

FROZEN = "method.retest_visibility=False"
"""Pairs separated by the crack are chosen once, in the first configuration, and never again."""


def norms(results: Results, fields: tuple[str, ...], kind: str = "rms") -> dict[str, pd.DataFrame]:
    """Error norms of some fields over the thesis's grid. kind: "rms", or "rms_inner" without frame and
    tip.
    """
    return {field: whole_grid(results, f"{field}_{kind}", CRACK) for field in fields}


def frozen_visibility(results: Results, scene: str) -> str:
    """In words: what G1 becomes with the visibility of the first configuration. Empty if not stored."""
    base, frozen = (option(results, scene, changed, "G1_error") for changed in ("", FROZEN))
    if base is None or frozen is None:
        return ""
    return (
        "with visibility frozen in the first configuration instead of tested at every step G1 is "
        f"{percent(frozen)} instead of {percent(base)} at (40, 1.5)"
    )
