"""Scenes, methods, solvers, metrics, studies.

    sphstudy list

Prints all names that the program knows, with a line on each.
"""

import ast
import shutil
import textwrap
from pathlib import Path

import yaml

from sphstudy import catalogue
from sphstudy.commands.parser import Request

PLACES = {
    "scene": ("kind", "model/scenes"),
    "method": ("kind", "numerics/methods"),
    "solve": ("name", "numerics/solvers"),
}
"""For each group of settings, the key that names a module, and the folder of that."""

_PACKAGE = Path(catalogue.__file__).parent


def run(request: Request) -> int:
    """Prints scenes, methods, solvers, metrics and studies."""
    for group in PLACES:
        _print(group, {name: about(group, name) for name in catalogue.names(group)})
    metrics = dict.fromkeys(m for scene in catalogue.names("scene") for m in catalogue.metrics(scene))
    _print("metrics", {name: _about(_PACKAGE / "metrics" / f"{name}.py") for name in metrics})
    studies = sorted(catalogue.folder("studies").glob("*.yaml"))
    _print("studies", {path.stem: yaml.safe_load(path.read_text())["title"] for path in studies})
    return 0


def about(group: str, name: str) -> str:
    """A line about a scene, method or solver: the title in its file, or the first line of its module.

    Parameters
    ----------
    group : {"scene", "method", "solve"}
        What it is.
    name : str
        Its name.

    Raises
    ------
    ConfigurationError
        If there is none of that name.
    """
    key, place = PLACES[group]
    settings = catalogue.settings(group, name)
    if title := settings.get("title"):
        return str(title)
    return _about(_PACKAGE / place / f"{settings.get(group, settings)[key]}.py")


def _about(path: Path) -> str:
    """The first line of a module, which is not imported: that would take seconds."""
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) if path.is_file() else ""
    return (text or "").partition("\n")[0]


def _print(heading: str, lines: dict[str, str]) -> None:
    print(f"{heading}:")
    width, indent = shutil.get_terminal_size((400, 24)).columns, 20 * " "
    for name, text in lines.items():
        print(textwrap.fill(text, width, initial_indent=f"  {name:17s} ", subsequent_indent=indent))
