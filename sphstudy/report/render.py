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
"""Pixels to an inch, as a page counts them."""

_COLOURS = 128
"""Of an animation: enough for a map of colours, and fewer bytes than 256."""

_PIXELS = 18e6
"""Of all frames of an animation together: a bit more than a megabyte."""


@dataclass(frozen=True)
class Drawing:
    """A figure of a study as drawn: a picture in base 64, or what is missing, or what went wrong.

    width, height: of the picture, in pixels of a screen. wide: wider than the style's usual figure.
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
        """What it is called: "Figure 4.2a", or its name where the thesis has no such figure."""
        return f"Figure {self.number}" if self.number[:1].isdigit() else self.number.capitalize()


def draw_all(results: Results, folder: Path) -> list[Drawing]:
    """Draws every figure that the study lists into <folder>/<name>.png and .pdf, or .gif if it moves.

    What goes wrong in drawing a figure is said in its place, and on standard error with the line.
    """
    folder.mkdir(parents=True, exist_ok=True)
    drawn = [_drawn(name, results, folder) for name in results.definition.figures]
    # Writing files, not drawing, is what takes time: all processors share it.
    jobs = min(loky.cpu_count(), sum(figure is not None for _, figure in drawn))
    if jobs < 2:
        return [_written(drawing, figure, folder) for drawing, figure in drawn]
    drawings, figures = zip(*drawn, strict=True)
    return list(loky.get_reusable_executor(jobs).map(_written, drawings, figures, repeat(folder)))


def _drawn(name: str, results: Results, folder: Path) -> tuple[Drawing, Figure | Animation | None]:
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
    """Writes all frames, from the first to the last, which the figure shows afterwards. One palette."""
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
        frames.append(Image.fromarray(np.array(canvas.buffer_rgba())).convert("RGB"))
    width, height = frames[0].size
    chosen = frames[:: max(1, len(frames) // 4)]
    together = Image.new("RGB", (width, height * len(chosen)))
    for k, frame in enumerate(chosen):
        together.paste(frame, (0, height * k))
    palette = together.quantize(_COLOURS, Image.Quantize.MAXCOVERAGE)
    first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
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
