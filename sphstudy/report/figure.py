"""What a figure is: a function that draws a study's results, with a number and a caption.

A figure is a function in a module of `sphstudy.report.figures`, decorated by `figure`: it takes Results
and returns a matplotlib Figure or an Animation, or raises Missing where the store lacks what it shows. A
study file names it module.function. What `figures` decorates draws several figures, module.name each.
Where `{}` stands in number and caption, the function takes a last argument (str) from the study file:
module.function.argument.
"""

import importlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.errors import ConfigurationError, unknown

_FOLDER = Path(__file__).parent / "figures"

STYLE = Path(__file__).parent / "figures.mplstyle"
"""The style sheet of all figures."""


@dataclass(frozen=True)
class Animation:
    """A figure that moves: `draw` makes it show frame 0 to frames - 1; duration: of each frame (s)."""

    figure: Figure
    draw: Callable[[int], None]
    frames: int
    duration: float = 0.12


@dataclass(frozen=True, eq=False)
class FigureDefinition:
    """number: the thesis's ("4.2a"), or a name. arguments: what function takes beside the results."""

    name: str
    number: str
    caption: str
    function: Callable[..., Any]
    arguments: tuple[Any, ...] = ()

    def draw(self, results: Results) -> Any:
        """The Figure or Animation; raises Missing if the store lacks what it shows."""
        return self.function(results, *self.arguments)

    def of(self, argument: str) -> "FigureDefinition":
        """The figure of this argument, which stands for {} in number and caption."""
        name = f"{self.name}.{argument}"
        number, caption = (text.replace("{}", argument) for text in (self.number, self.caption))
        return FigureDefinition(name, number, caption, self.function, (*self.arguments, argument))


def figure(number: str, caption: str) -> Callable[[Callable[..., Any]], FigureDefinition]:
    """Decorator: makes a figure of a function that draws results; {}: see the module."""
    return lambda draw: FigureDefinition(_name(draw, draw.__name__), number, caption, draw)


def figures(**variants: tuple[Any, ...]) -> Callable[[Callable[..., Any]], list[FigureDefinition]]:
    """Decorator: makes several figures of one function.

    Parameters
    ----------
    **variants
        For each figure, by its name: number, caption, and what the function takes beside the results.
    """
    return lambda draw: [
        FigureDefinition(_name(draw, name), number, caption, draw, tuple(arguments))
        for name, (number, caption, *arguments) in variants.items()
    ]


def _name(draw: Callable[..., Any], name: str) -> str:
    return f"{draw.__module__.rpartition('.')[2]}.{name}"


def defined(module: ModuleType) -> Iterator[FigureDefinition]:
    """The figures that a module defines."""
    for value in vars(module).values():
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, FigureDefinition):
                yield one


def find(name: str) -> FigureDefinition:
    """The figure that a study file names so.

    Raises
    ------
    ConfigurationError
        If there is none.
    """
    module, function, argument, *_ = *name.split(".", 2), "", ""
    try:
        there = list(defined(importlib.import_module(f"sphstudy.report.figures.{module}")))
    except ModuleNotFoundError:
        modules = (f"{path.stem}.…" for path in sorted(_FOLDER.glob("[!_]*.py")))
        raise ConfigurationError([unknown("figure", name, modules)]) from None
    for found in there:
        if found.name == f"{module}.{function}" and bool(argument) == ("{}" in found.number):
            return found.of(argument) if argument else found
    names = (one.name + (".…" if "{}" in one.number else "") for one in there)
    raise ConfigurationError([unknown("figure", name, names)])
