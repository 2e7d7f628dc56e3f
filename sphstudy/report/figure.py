"""What a figure is: a function from a study's results to a matplotlib figure, with number and caption.

A study file names its figures as module.function; the module is one of `sphstudy.report.figures`. Of a
family, a figure for each of whatever it can be drawn for, module.function.subject.
"""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.errors import ConfigurationError

STYLE = Path(__file__).parent / "figures.mplstyle"
"""The one style sheet of all figures."""


@dataclass(frozen=True)
class Animation:
    """A figure that moves: `draw` makes it show frame 0 to frames - 1; duration: of each frame (s)."""

    figure: Figure
    draw: Callable[[int], None]
    frames: int
    duration: float = 0.12


Drawn = TypeVar("Drawn", Figure, Animation)


@dataclass(frozen=True)
class FigureDefinition(Generic[Drawn]):
    """number: the thesis's ("4.2a"), or a name; draw raises Missing if the store lacks what it needs."""

    name: str
    number: str
    caption: str
    draw: Callable[[Results], Drawn]


@dataclass(frozen=True)
class Family(Generic[Drawn]):
    """Figures that differ in their subject only, which stands for {} in number and caption."""

    name: str
    number: str
    caption: str
    draw: Callable[[Results, str], Drawn]

    def member(self, subject: str) -> FigureDefinition[Drawn]:
        """The figure of a subject."""
        number, caption = (text.replace("{}", subject) for text in (self.number, self.caption))

        def draw(results: Results) -> Drawn:
            return self.draw(results, subject)

        return FigureDefinition(f"{self.name}.{subject}", number, caption, draw)


def figure(number: str, caption: str) -> Callable[[Callable[[Results], Drawn]], FigureDefinition[Drawn]]:
    """Decorator: makes a FigureDefinition of a function that draws from results."""

    def wrapped(draw: Callable[[Results], Drawn]) -> FigureDefinition[Drawn]:
        return FigureDefinition(_name(draw), number, caption, draw)

    return wrapped


def family(number: str, caption: str) -> Callable[[Callable[[Results, str], Drawn]], Family[Drawn]]:
    """Decorator: makes a Family of a function that draws from results what its second argument names."""

    def wrapped(draw: Callable[[Results, str], Drawn]) -> Family[Drawn]:
        return Family(_name(draw), number, caption, draw)

    return wrapped


def _name(draw: Callable[..., Any]) -> str:
    return f"{draw.__module__.rpartition('.')[2]}.{draw.__name__}"


def find(name: str) -> FigureDefinition[Any]:
    """The figure called module.function or module.function.subject. Raises ConfigurationError if there is
    none.
    """
    module, function, subject, *_ = *name.split(".", 2), "", ""
    try:
        found = getattr(importlib.import_module(f"sphstudy.report.figures.{module}"), function)
    except (ModuleNotFoundError, AttributeError):
        raise ConfigurationError([f"figure {name}: there is no such figure"]) from None
    if isinstance(found, Family) and subject:
        return found.member(subject)
    if not isinstance(found, FigureDefinition) or subject:
        raise ConfigurationError([f"figure {name}: there is no such figure"])
    return found
