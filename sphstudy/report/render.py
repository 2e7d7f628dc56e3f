"""Draws the figures of a study to files, and says in words why one could not be drawn."""

import base64
import math
import sys
import traceback
from dataclasses import dataclass, replace
from itertools import repeat
from pathlib import Path

import loky
import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from sphstudy.analysis.results import Missing, Results
from sphstudy.report.figure import STYLE, Animation, find

_SCREEN = 96
"""Pixels of a page in an inch."""

_COLOURS = 128
"""Colours of an animation: enough for a map of colours, and fewer bytes than 256."""

_PIXELS = 18e6
"""Pixels of all frames of an animation together: a bit more than a megabyte."""


@dataclass(frozen=True)
class Drawing:
    """A figure of a study as drawn: a picture in base 64, or what is missing, or what went wrong.

    width, height: of the picture (pixels of a screen). wide: wider than the style's usual figure.
    """

    name: str
    number: str
    caption: str
    image: str = ""
    format: str = "png"
    width: int = 0
    height: int = 0
    wide: bool = False
    missing: str = ""
    error: str = ""

    @property
    def title(self) -> str:
        """The thesis's number as in "Figure 4.2a", or the name of a figure that the thesis lacks."""
        return f"Figure {self.number}" if self.number[:1].isdigit() else self.number.capitalize()


def draw_all(results: Results, folder: Path) -> list[Drawing]:
    """Draws the figures of a study.

    Parameters
    ----------
    results : Results
        The study, which lists them.
    folder : Path
        Where <name>.png and .pdf are written, and .gif of a figure that moves.

    Returns
    -------
    list of Drawing
        In the study's order. An error in drawing stands in them, and with its line on standard error.
    """
    folder.mkdir(parents=True, exist_ok=True)
    drawn = [_drawn(name, results, folder) for name in results.definition.figures]
    # Writing files takes longer than drawing: all processors share it.
    jobs = min(loky.cpu_count(), sum(figure is not None for _, figure in drawn))
    if jobs < 2:
        return [_written(drawing, figure, folder) for drawing, figure in drawn]
    drawings, figures = zip(*drawn, strict=True)
    return list(loky.get_reusable_executor(jobs).map(_written, drawings, figures, repeat(folder)))


def _drawn(name: str, results: Results, folder: Path) -> tuple[Drawing, Figure | Animation | None]:
    """What the figure is, or why there is none."""
    # The files of an earlier report must not outlive the data that it drew.
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


def _written(drawing: Drawing, drawn: Figure | Animation | None, folder: Path) -> Drawing:
    """Writes the figure, if there is one, to its files."""
    if drawn is None:
        return drawing
    figure = drawn.figure if isinstance(drawn, Animation) else drawn
    png, pdf, gif = _files(drawing.name, folder)
    try:
        with matplotlib.rc_context(fname=STYLE):
            if isinstance(drawn, Animation):
                _write_moving(drawn, gif)
            figure.savefig(png, metadata={"Software": None})
            if isinstance(drawn, Figure):
                # Laid out once, which is most of the work. No date: the same data make the same file.
                figure.set_layout_engine("none")
                figure.savefig(pdf, metadata={"CreationDate": None})
            wide = figure.get_figwidth() > matplotlib.rcParams["figure.figsize"][0]
    except Exception as error:
        return _failed(drawing, error)
    width, height = (round(_SCREEN * inches) for inches in figure.get_size_inches())
    shown = gif if isinstance(drawn, Animation) else png
    image = base64.b64encode(shown.read_bytes()).decode()
    format = shown.suffix.removeprefix(".")
    return replace(drawing, image=image, format=format, width=width, height=height, wide=wide)


def _write_moving(animation: Animation, path: Path) -> None:
    """Writes all frames with one palette; the figure shows the last one afterwards."""
    figure, frames = animation.figure, []
    pixels = animation.frames * _SCREEN**2 * figure.get_figwidth() * figure.get_figheight()
    resolution = _SCREEN * min(1.0, math.sqrt(_PIXELS / pixels))
    canvas = FigureCanvasAgg(figure)
    figure.set_dpi(resolution)
    for k in range(animation.frames):
        animation.draw(k)
        canvas.draw()
        # Laid out once: nothing but what moves may move.
        figure.set_layout_engine("none")
        frames.append(np.array(canvas.buffer_rgba())[:, :, :3])
    palette = Image.fromarray(np.concatenate(frames[:: max(1, len(frames) // 4)])).quantize(
        _COLOURS, Image.Quantize.MAXCOVERAGE
    )
    images = (Image.fromarray(frame) for frame in frames)
    first, *others = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images)
    milliseconds = round(1000.0 * animation.duration)
    first.save(path, save_all=True, append_images=others, duration=milliseconds, loop=0, optimize=True)


def _files(name: str, folder: Path) -> tuple[Path, Path, Path]:
    return folder / f"{name}.png", folder / f"{name}.pdf", folder / f"{name}.gif"


def _failed(drawing: Drawing, error: Exception) -> Drawing:
    said = f"{type(error).__name__}: {error}"
    place = traceback.extract_tb(error.__traceback__)[-1]
    line = f"{Path(place.filename).name}:{place.lineno}"
    print(f"figure {drawing.name}: {said} ({line})", file=sys.stderr)
    return replace(drawing, error=said)
