"""The change of each metric by each setting, in blocks that vary one setting at a time."""

from dataclasses import dataclass

import pandas as pd

from sphstudy.analysis.results import Results

CONTROL = "scene.rho"
"""A setting that is changed in its eleventh digit only: its effect shows how far rounding may grow."""


@dataclass(frozen=True)
class Effect:
    """Change of a metric by one setting, everything else as in the block."""

    block: str
    varied: str
    metric: str
    base: float
    value: float
    units: str

    @property
    def change(self) -> float:
        """value - base, in the metric's unit."""
        return self.value - self.base

    @property
    def is_control(self) -> bool:
        """Whether the change of the setting should change nothing but rounding."""
        return self.varied.startswith(CONTROL)


def effects(results: Results) -> list[Effect]:
    """All effects in a study: of each block that varies settings, each setting on each metric.

    Parameters
    ----------
    results : Results
        The study; points without a record and metrics without a value are left out.
    """
    found: list[Effect] = []
    table = results.table
    metrics = [name for name, a in results.attributes.items() if a.get("group") == "metric"]
    for block in table.loc[table["varied"] != "", "block"].unique():
        rows = table[table["block"] == block]
        base = rows[rows["varied"] == ""].iloc[0]
        for _, row in rows[rows["varied"] != ""].iterrows():
            for metric in metrics:
                if pd.notna(base[metric]) and pd.notna(row[metric]):
                    units = str(results.attributes[metric]["units"])
                    values = float(base[metric]), float(row[metric])
                    found.append(Effect(str(block), str(row["varied"]), metric, *values, units))
    return found
