"""Draws the figures of a study to files, and says in words why one could not be drawn."""

import base64
import sys
import traceback
from dataclasses import dataclass, replace
from pathlib import Path

import joblib
import matplotlib
from matplotlib.figure import Figure

from sphstudy.report.figure import STYLE, find
from sphstudy.results import Missing, Results

_SCREEN = 96
"""Pixels to an inch, as a page counts them."""


@dataclass(frozen=True)
class Drawing:
    """A figure of a study as drawn: a PNG in base 64, or what is missing, or what went wrong.

    width, height: of the picture, in pixels of a screen. wide: wider than the style's usual figure.
    """

    name: str
    number: str
    caption: str
    image: str = ""
    width: int = 0
    height: int = 0
    wide: bool = False
    missing: str = ""
    error: str = ""

    @property
    def title(self) -> str:
        """What it is called: "Figure 4.2a", or its name where the thesis has no such figure."""
        return f"Figure {self.number}" if self.number[:1].isdigit() else self.number.capitalize()


def draw_all(results: Results, folder: Path) -> list[Drawing]:
    """Draws every figure that the study lists into <folder>/<name>.png and .pdf.

    What goes wrong in drawing a figure is said in its place, and on standard error with the line.
    """
    folder.mkdir(parents=True, exist_ok=True)
    drawn = [_drawn(name, results, folder) for name in results.definition.figures]
    # Writing files, not drawing, is what takes time: all processors share it.
    jobs = min(joblib.cpu_count(), max(1, sum(figure is not None for _, figure in drawn)))
    return joblib.Parallel(n_jobs=jobs)(
        joblib.delayed(_written)(drawing, figure, folder) for drawing, figure in drawn
    )


def _drawn(name: str, results: Results, folder: Path) -> tuple[Drawing, Figure | None]:
    """What the figure is, or why there is none."""
    # What an earlier report drew must not outlive the data it was drawn from.
    for file in _files(name, folder):
        file.unlink(missing_ok=True)
    drawing = Drawing(name, number=name, caption="")
    try:
        definition = find(name)
        drawing = Drawing(name, definition.number, definition.caption)
        with matplotlib.rc_context(fname=STYLE):
            return drawing, definition.draw(results)
    except Missing as missing:
        return replace(drawing, missing=str(missing)), None
    except Exception as error:
        return _failed(drawing, error), None


def _written(drawing: Drawing, figure: Figure | None, folder: Path) -> Drawing:
    """Writes the figure, if there is one, to its files."""
    if figure is None:
        return drawing
    png, pdf = _files(drawing.name, folder)
    try:
        with matplotlib.rc_context(fname=STYLE):
            figure.savefig(png, metadata={"Software": None})
            # Laid out once, which is most of the work. No date: the same data make the same file.
            figure.set_layout_engine("none")
            figure.savefig(pdf, metadata={"CreationDate": None})
            wide = figure.get_figwidth() > matplotlib.rcParams["figure.figsize"][0]
    except Exception as error:
        return _failed(drawing, error)
    width, height = (round(_SCREEN * inches) for inches in figure.get_size_inches())
    image = base64.b64encode(png.read_bytes()).decode()
    return replace(drawing, image=image, width=width, height=height, wide=wide)


def _files(name: str, folder: Path) -> tuple[Path, Path]:
    return folder / f"{name}.png", folder / f"{name}.pdf"


def _failed(drawing: Drawing, error: Exception) -> Drawing:
    said = f"{type(error).__name__}: {error}"
    place = traceback.extract_tb(error.__traceback__)[-1]
    line = f"{Path(place.filename).name}:{place.lineno}"
    print(f"figure {drawing.name}: {said} ({line})", file=sys.stderr)
    return replace(drawing, error=said)
