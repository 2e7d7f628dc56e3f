"""Tables of the cheapest setting for an error, of each scene with several methods or solvers."""

from sphstudy import text
from sphstudy.analysis import work_precision
from sphstudy.analysis.results import Results
from sphstudy.analysis.work_precision import Choice
from sphstudy.table import Cell, Column, Table

NONE = "no point reaches it"


def tables(results: Results) -> list[Table]:
    """A table for each scene: the cheapest setting within each of work_precision.BOUNDS."""
    own = results.table[results.table["study"] == results.name]
    found = []
    for scene in dict.fromkeys(own["scene"]):
        rows = own[own["scene"] == scene]
        if scene in work_precision.ERRORS and rows[["method", "solve"]].drop_duplicates().shape[0] > 1:
            points = work_precision.points(rows, scene)
            if not points["error"].isna().all():
                found.append(
                    _table(
                        scene,
                        [
                            (bound, work_precision.cheapest(points, bound))
                            for bound in work_precision.BOUNDS
                        ],
                    )
                )
    return found


def _table(scene: str, chosen: list[tuple[float, Choice | None]]) -> Table:
    columns = [
        Column("error at most (%)"),
        Column("cheapest setting", numeric=False),
        Column("its error (%)"),
        Column("CPU (s)", "CPU time without compilation"),
        Column("standing", "whether a finer resolution with the same settings confirms it", False),
    ]
    error = work_precision.ERRORS[scene].replace("_", " ")
    caption = f"Cheapest setting for an error in scene {scene} ({error})"
    return Table(caption, columns, [_row(bound, choice) for bound, choice in chosen])


def _row(bound: float, choice: Choice | None) -> list[Cell]:
    asked = Cell(text.number(100.0 * bound, 3), bound)
    if choice is None:
        return [asked, Cell(NONE), Cell(text.NOTHING), Cell(text.NOTHING), Cell("")]
    row = choice.row
    return [
        asked,
        Cell(work_precision.label(row)),
        Cell(text.number(100.0 * row["error"], 3, sign=True), row["error"]),
        Cell(text.number(row["cpu_seconds"], 2), row["cpu_seconds"]),
        Cell(standing(choice)),
    ]


def standing(choice: Choice) -> str:
    """How far one can rely on the choice, in words."""
    if choice.confirmed:
        turns = ", though the sign changes" if choice.row["turns"] else ""
        return f"confirmed by all finer resolutions{turns}"
    if choice.row["lucky"]:
        return "lucky: a finer resolution is farther off"
    return "not confirmed: no finer resolution"
