"""`sphstudy judge STUDY`: the stability map of stored results, on the console."""

from rich.box import SIMPLE_HEAD
from rich.table import Table as Printed

from sphstudy.analysis.results import load
from sphstudy.analysis.stability.cases import judged
from sphstudy.commands.review import named
from sphstudy.configuration.composition import session
from sphstudy.console import console
from sphstudy.report.stability_tables import bounds, counts, quoted, stability_map
from sphstudy.table import Table


def judge_command(arguments: list[str]) -> int:
    """Prints which runs of a study are sound, degraded or diverged, when and by what, and the bounds.

    Raises ConfigurationError on wrong input, wrong files of bounds among it.
    """
    name, overrides = named(arguments, "judge")
    with session() as hydra:
        results = load(name, hydra, overrides)
        cases = judged(results)
    for table in (stability_map(cases), bounds(cases), quoted(results, cases)):
        if table is not None:
            _print(table)
    print(f"judged: {counts(cases)}")
    return 0


def _print(table: Table) -> None:
    printed = Printed(title=table.caption, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for column in table.columns:
        printed.add_column(column.title, justify="right" if column.numeric else "left", overflow="fold")
    for row in table.rows:
        printed.add_row(*(cell.text for cell in row))
    console().print(printed)
