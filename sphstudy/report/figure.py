"""What a figure is: a function from a study's results to a matplotlib figure, with number and caption.

A study file names its figures as module.function; the module is one of `sphstudy.report.figures`.
"""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from sphstudy.config import ConfigurationError
from sphstudy.results import Results

STYLE = Path(__file__).parent / "figures.mplstyle"
"""The one style sheet of all figures."""


@dataclass(frozen=True)
class FigureDefinition:
    """number: the thesis's ("4.2a"), or a name; draw raises Missing if the store lacks what it needs."""

    name: str
    number: str
    caption: str
    draw: Callable[[Results], Figure]


def figure(number: str, caption: str) -> Callable[[Callable[[Results], Figure]], FigureDefinition]:
    """Decorator: makes a FigureDefinition of a function that draws from results."""

    def wrapped(draw: Callable[[Results], Figure]) -> FigureDefinition:
        module = draw.__module__.rpartition(".")[2]
        return FigureDefinition(f"{module}.{draw.__name__}", number, caption, draw)

    return wrapped


def find(name: str) -> FigureDefinition:
    """The figure called module.function. Raises ConfigurationError if there is none."""
    module, _, function = name.partition(".")
    try:
        found = getattr(importlib.import_module(f"sphstudy.report.figures.{module}"), function)
    except (ModuleNotFoundError, AttributeError):
        raise ConfigurationError([f"figure {name}: there is no such figure"]) from None
    if not isinstance(found, FigureDefinition):
        raise ConfigurationError([f"figure {name}: there is no such figure"])
    return found
