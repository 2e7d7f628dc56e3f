"""Overrides, `key=value`: their grammar, what is wrong with them, and the grid that they span."""

import itertools
import math
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.errors import HydraException

from sphstudy.errors import ConfigurationError, unknown

MOST_POINTS = 100_000
"""Points of one sweep at most: more are a typing error, and would fill the memory."""

SEARCH_PATH = "hydra.searchpath="

_LAUNCHER = ("hydra/launcher", "hydra.launcher")
_NAMES = ("scene.name", "method.name", "solve.name")


@dataclass(frozen=True)
class Setting:
    """An override `line`. If it does not choose a file of a group (`scene=plate`), it sets the key `name`
    in the dictionary that `path` leads to.
    """

    line: str
    is_group: bool
    path: tuple[str, ...]
    name: str
    value: Any


class Grammar:
    """Reads overrides. `options` returns the names in a group of settings: none if there is no group."""

    def __init__(self, options: Callable[[str], list[str]]):
        self._parser = OverridesParser.create()
        self._options = options
        # Large grids are made of the same few overrides.
        self.setting = cache(self._setting)

    def parsed(self, arguments: list[str]) -> list[Override]:
        """Overrides as Hydra understands them. Raises ConfigurationError with every complaint about form
        and about names in groups; values of other settings are not looked at.
        """
        complaints: list[str] = []
        found: list[Override] = []
        for argument in arguments:
            try:
                if "\0" in argument:
                    raise ValueError("no file has such a name")
                override = self._parser.parse_override(_as_text(argument))
            except (HydraException, ValueError, RecursionError):
                complaints.append(f"{_shortened(argument)}: not understood; write key=value")
                continue
            complaints += self._complaint(override)
            if any(other.key_or_group == override.key_or_group for other in found):
                complaints.append(f"{argument}: {override.key_or_group} is given twice")
            found.append(override)
        if not complaints and (points := _spanned(found)) > MOST_POINTS:
            complaints.append(f"a sweep of {points:,} points or more: at most {MOST_POINTS:,}")
        if complaints:
            raise ConfigurationError(complaints)
        return found

    def _complaint(self, override: Override) -> Iterator[str]:
        line, key = str(override.input_line), override.key_or_group
        if override.is_add() or override.is_delete() or override.package is not None:
            yield f"{line}: write key=value; keys cannot be added, deleted or moved"
        elif "${" in line:
            yield f"{line}: interpolations are not taken from the command line"
        elif key in _NAMES:
            yield f"{line}: the name is that of the file; {key.partition('.')[0]}=NAME chooses another"
        elif key.startswith("hydra"):
            yield f"{line}: of Hydra's own keys, hydra/launcher and hydra.launcher.* can be set"
        elif override.is_sweep_override() and not override.is_discrete_sweep():
            yield f"{line}: write single values, or a range"
        elif (count := _spanned([override])) > MOST_POINTS:
            yield f"{line}: more than {MOST_POINTS:,} values"
        elif count == 0:
            yield f"{line}: stands for no values"
        elif "." not in key and (options := self._options(key)):
            many = override.is_sweep_override()
            values = override.sweep_iterator() if many else [override.value()]
            wrong = [value for value in values if value not in options]
            yield from [unknown(key, value, options) for value in wrong[:1]]

    def _setting(self, text: str) -> Setting:
        override = self._parser.parse_override(text)
        *path, name = override.key_or_group.split(".")
        is_group = bool(self._options(override.key_or_group))
        value = None if is_group else rounded(override.value())
        return Setting(str(override.input_line), is_group, tuple(path), name, value)


def grid(overrides: list[Override]) -> list[tuple[str, ...]]:
    """The points that overrides span: for each, one `key=value` an override; the last varies fastest."""

    def single(override: Override) -> list[str]:
        key, many = override.get_key_element(), override.is_sweep_override()
        values = override.sweep_string_iterator() if many else [override.get_value_element_as_str()]
        return [f"{key}={value}" for value in values]

    return list(itertools.product(*map(single, overrides)))


def applied(settings: Iterable[Setting], values: dict[str, Any]) -> dict[str, Any]:
    """Nested values with some of them set, groups left out. Raises ConfigurationError with every key that
    they do not have.
    """
    # Only what changes is copied: there may be 20 000 points.
    changed = dict(values)
    complaints = []
    for one in settings:
        if one.is_group:
            continue
        node: Any = changed
        for part in one.path:
            if isinstance(inner := node.get(part), dict):
                node[part] = dict(inner)
            node = node.get(part) if isinstance(inner, dict) else {}
        if one.name in node:
            node[one.name] = one.value
        else:
            complaints.append(_no_setting(values, one))
    if complaints:
        raise ConfigurationError(complaints)
    return changed


def _no_setting(values: dict[str, Any], given: Setting) -> str:
    path, node = [*given.path], values
    for part in path:
        node = node.get(part) if isinstance(node, dict) else None  # type: ignore[assignment]
    if not isinstance(node, dict):
        path, node = [], values
    known = sorted(".".join([*path, str(name)]) for name in node)
    return f"{given.line}: {unknown('setting', '.'.join([*given.path, given.name]), known)}"


def launcher_overrides(arguments: list[str]) -> list[str]:
    """Those arguments that choose or configure the launcher, not the runs."""
    return [a for a in arguments if a.startswith(_LAUNCHER)]


def searched(argument: str) -> list[str]:
    """Folders of `hydra.searchpath=[folder, …]`. Raises ConfigurationError if it is anything else."""
    try:
        value = OverridesParser.create().parse_override(argument).value()
    except (HydraException, ValueError, RecursionError):
        value = None
    folders = value if isinstance(value, list) else [value]
    places = [place.removeprefix("file://") for place in folders if isinstance(place, str)]
    if len(places) < len(folders) or any(not p or "://" in p or "${" in p for p in places):
        raise ConfigurationError([f"{_shortened(argument)}: write {SEARCH_PATH}[folder,folder]"])
    return places


def rounded(values: Any) -> Any:
    """Values, nested or single, floats to 12 digits: range(1,2,0.1) must not make two values of 1.9."""
    if isinstance(values, dict):
        return {key: rounded(value) for key, value in values.items()}
    if isinstance(values, list):
        return [rounded(value) for value in values]
    return float(f"{values:.12g}") if isinstance(values, float) else values


def _as_text(argument: str) -> str:
    """`results=FOLDER` with its folder in quotes: whatever its characters, it is text."""
    key, _, folder = argument.partition("=")
    if key != "results" or not folder or folder[0] in "'\"":
        return argument
    # In quotes, backslashes escape a quote behind them, and one another before one.
    inner = re.sub(r"(\\*)('|$)", lambda found: 2 * found[1] + found[2].replace("'", "\\'"), folder)
    return f"results='{inner}'"


def _shortened(text: str) -> str:
    return text if len(text) <= 100 else f"{text[:100]}…"


def _spanned(overrides: list[Override]) -> int:
    """How many points overrides span, counted no further than one too many."""
    return math.prod(_values(o) for o in overrides if o.is_sweep_override())


def _values(override: Override) -> int:
    try:
        return sum(1 for _ in itertools.islice(override.sweep_iterator(), MOST_POINTS + 1))
    except (HydraException, ValueError, ArithmeticError):
        # A range() with a step of zero or with ends that are no numbers, a glob() where no names are.
        return 0
