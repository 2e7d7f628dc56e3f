"""From the command line to points: Hydra composes, wrong input is answered before anything runs."""

import dataclasses
import difflib
import itertools
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from typing import Any

from hydra import initialize_config_dir
from hydra._internal.core_plugins.basic_sweeper import BasicSweeper
from hydra.core.global_hydra import GlobalHydra
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.errors import HydraException
from hydra.types import RunMode
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from sphstudy import catalogue
from sphstudy.catalogue import solver_module
from sphstudy.configuration.execution import RETRIES, Execution
from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.errors import ConfigurationError
from sphstudy.parameters import checked

LAUNCHERS = ("local", "basic", "slurm")
"""Side by side on this machine, one after the other in this process, jobs of a SLURM cluster."""

MOST_POINTS = 100_000
"""Of one sweep: more are a slip of the pen, and take all memory."""

_LAUNCHER = ("hydra/launcher", "hydra.launcher")


@dataclass(frozen=True)
class Point:
    """One run of a sweep: the overrides that make it, the configuration they make, how it is run."""

    overrides: tuple[str, ...]
    config: RunConfig
    execution: Execution
    retry: str = "none"


@dataclass(frozen=True)
class Launcher:
    """What gets runs done: one of LAUNCHERS, and its settings (conf/hydra/launcher)."""

    name: str
    settings: dict[str, Any]


@dataclass(frozen=True)
class _Taken:
    """An override as it is applied: what was written, and whether it chooses from a group; if not, which
    value below a path of keys it sets, and to what.
    """

    line: str
    is_group: bool
    path: tuple[str, ...]
    name: str
    value: Any


class _NotValid(ConfigurationError):
    """A point that was composed but does not make a run."""


class Session:
    """Hydra, ready to compose configurations from `conf/` and to launch runs."""

    def __init__(self):
        self._loader = GlobalHydra.instance().config_loader()
        self._parser = OverridesParser.create(config_loader=self._loader)
        self._composed: dict[tuple[str, ...], dict[str, Any]] = {}
        # Hydra looks through its folders every time it is asked.
        self._options = cache(self._loader.get_group_options)
        # The same few overrides make a large grid.
        self._taken = cache(self._take)

    def points(
        self, arguments: list[str], sweep: bool, skipped: list[str] | None = None
    ) -> tuple[list[Point], str]:
        """All points that the overrides span, validated, and the folder of their results.

        Raises ConfigurationError with all complaints. Without `sweep`, a list of values is one. Given a
        list `skipped`, points that are not valid are left out, and the complaints added to it.
        """
        overrides = self._parse([a for a in arguments if a not in launcher_overrides(arguments)])
        if not sweep:
            many = [o for o in overrides if o.is_sweep_override()]
            if many:
                raise ConfigurationError(
                    [f"{o.input_line}: several values make a sweep: add -m" for o in many]
                )
        if (spanned := _spanned(overrides)) > MOST_POINTS:
            raise ConfigurationError([f"a sweep of {spanned:,} points or more: at most {MOST_POINTS:,}"])
        grid = BasicSweeper.split_arguments(overrides, None)[0]
        complaints: dict[str, None] = {}
        points: list[Point] = []
        results = set()
        for choice in grid:
            try:
                composed = self._compose(choice)
                results.add(str(composed.pop("results")))
                retry, execution = composed.pop("retry"), taken_execution(composed)
                if retry not in RETRIES:
                    raise ConfigurationError([f"retry={retry}: there is {', '.join(RETRIES)}"])
                config = self._validated(composed)
                if complaint := _too_many(execution.threads, config):
                    raise ConfigurationError([complaint])
                points.append(Point(tuple(choice), config, execution, retry))
            except _NotValid as error:
                if skipped is None:
                    complaints |= dict.fromkeys(error.complaints)
                else:
                    skipped += error.complaints
            except ConfigurationError as error:
                complaints |= dict.fromkeys(error.complaints)
            except (HydraException, OmegaConfBaseException) as error:
                complaints[f"{' '.join(choice)}: {str(error).splitlines()[0]}"] = None
        if len(results) > 1:
            complaints["results: one folder for all points, please"] = None
        if complaints:
            raise ConfigurationError(list(complaints))
        return points, results.pop()

    def _validated(self, composed: dict[str, Any]) -> RunConfig:
        try:
            return validate(composed)
        except ConfigurationError as error:
            raise _NotValid(error.complaints) from None

    def _parse(self, arguments: list[str]) -> list[Override]:
        complaints = []
        overrides: list[Override] = []
        for argument in arguments:
            try:
                override = self._parser.parse_override(argument)
            except (HydraException, ValueError, RecursionError):
                complaints.append(f"{_shortened(argument)}: not understood; write key=value")
                continue
            complaints += self._complaint(override)
            if any(other.key_or_group == override.key_or_group for other in overrides):
                complaints.append(f"{argument}: {override.key_or_group} is given twice")
            overrides.append(override)
        if complaints:
            raise ConfigurationError(complaints)
        return overrides

    def _complaint(self, override: Override) -> Iterator[str]:
        """What is wrong with one override, before its value is looked at."""
        line, key = str(override.input_line), override.key_or_group
        if override.is_add() or override.is_delete() or override.package is not None:
            yield f"{line}: write key=value; keys cannot be added, deleted or moved"
        elif "${" in line:
            yield f"{line}: interpolations are not taken from the command line"
        elif key == "known":
            yield f"{line}: set by the program itself"
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
            for value in override.sweep_iterator() if many else [override.value()]:
                if value not in options:
                    yield f"{key}={value}: there is {', '.join(options)}"
                    break

    def _compose(self, overrides: list[str]) -> dict[str, Any]:
        """The plain dictionary for one point.

        Configuration groups are composed once per choice; single values are set on a copy.
        """
        taken = [self._taken(override) for override in overrides]
        chosen = tuple(one.line for one in taken if one.is_group)
        if chosen not in self._composed:
            config = self._loader.load_configuration("config", list(chosen), RunMode.RUN)
            self._composed[chosen] = _rounded(_without_hydra(config))
        # Plain dictionaries, of which only what changes is copied: there may be 20 000 of them.
        values = dict(self._composed[chosen])
        complaints = []
        for one in taken:
            if one.is_group:
                continue
            node: Any = values
            for part in one.path:
                if isinstance(inner := node.get(part), dict):
                    node[part] = dict(inner)
                node = node.get(part) if isinstance(inner, dict) else {}
            if one.name in node:
                node[one.name] = one.value
            else:
                complaints.append(_unknown(values, one))
        if complaints:
            raise ConfigurationError(complaints)
        return values

    def _take(self, text: str) -> _Taken:
        override = self._parser.parse_override(text)
        *path, name = override.key_or_group.split(".")
        is_group = bool(self._options(override.key_or_group))
        value = None if is_group else _rounded(override.value())
        return _Taken(str(override.input_line), is_group, tuple(path), name, value)

    def launcher(self, overrides: list[str]) -> Launcher:
        """The launcher that the configuration and the overrides name.

        Raises ConfigurationError if it is not offered, or if a setting of it does not exist or is wrong.
        """
        for override in overrides:
            key, _, value = override.partition("=")
            if key == "hydra/launcher" and value not in LAUNCHERS:
                raise ConfigurationError([f"{override}: there is {', '.join(LAUNCHERS)}"])
        try:
            config = self._loader.load_configuration("config", overrides, RunMode.MULTIRUN)
        except HydraException as error:
            raise ConfigurationError([f"{' '.join(overrides)}: {error}".splitlines()[0]]) from None
        settings: Any = OmegaConf.to_container(config.hydra.launcher)
        jobs = settings.get("n_jobs")
        if jobs is not None and (type(jobs) is not int or (jobs < 1 and jobs != -1)):
            raise ConfigurationError(
                [f"hydra.launcher.n_jobs={jobs}: should be a whole number above 0, or -1: one per core"]
            )
        name = config.hydra.runtime.choices["hydra/launcher"]
        if name == "slurm":
            from sphstudy.running.slurm.settings import settings_of

            settings_of(settings)
        return Launcher(name, settings)


def launcher_overrides(arguments: list[str]) -> list[str]:
    """Those arguments that choose or configure the launcher, not the runs."""
    return [a for a in arguments if a.startswith(_LAUNCHER)]


@contextmanager
def session() -> Iterator[Session]:
    """A Session on the project's configuration folder."""
    folder = str(catalogue.folder("conf").resolve())
    with initialize_config_dir(folder, version_base="1.3", job_name="sphstudy"):
        yield Session()


def taken_execution(composed: dict[str, Any]) -> Execution:
    """How a run is to be carried out, taken out of what Hydra composed.

    Raises ConfigurationError with every complaint.
    """
    complaints: list[str] = []
    values = {field.name: composed.pop(field.name) for field in dataclasses.fields(Execution)}
    found = checked(Execution, values, "", complaints)
    if complaints:
        raise ConfigurationError(complaints)
    return found


def _shortened(text: str) -> str:
    return text if len(text) <= 100 else f"{text[:100]}…"


def _spanned(overrides: list[Override]) -> int:
    """How many points overrides span, counted no further than too many."""
    return math.prod(_values(o) for o in overrides if o.is_sweep_override())


def _values(override: Override) -> int:
    try:
        return sum(1 for _ in itertools.islice(override.sweep_iterator(), MOST_POINTS + 1))
    except (HydraException, ValueError, ArithmeticError):
        return 0  # range() with steps of zero or ends that are none, glob() of what has no names


def _too_many(threads: int, config: RunConfig) -> str | None:
    """What is wrong with so many threads for this run."""
    if threads == 1:
        return None
    if threads > (cores := os.cpu_count() or 1):
        return f"threads={threads}: this machine has {cores} cores"
    if not solver_module(config.solve.name).THREADS:
        return f"threads={threads}: solver {config.solve.name} runs on one thread"
    return None


def _without_hydra(config: DictConfig) -> dict[str, Any]:
    """As plain dictionaries."""
    own = OmegaConf.create({key: config[key] for key in config if key != "hydra"})
    values: Any = OmegaConf.to_container(own, resolve=True)
    return values


def _rounded(values: Any) -> Any:
    """Floats to 12 significant digits: range(1,2,0.1) must not make two coordinates of 1.9."""
    if isinstance(values, dict):
        return {key: _rounded(value) for key, value in values.items()}
    if isinstance(values, list):
        return [_rounded(value) for value in values]
    return float(f"{values:.12g}") if isinstance(values, float) else values


def _unknown(values: dict[str, Any], given: _Taken) -> str:
    path, last = list(given.path), given.name
    node: Any = values
    for part in path:
        node = node.get(part) if isinstance(node, dict) else None
    if not isinstance(node, dict):
        node, path, last = values, [], ".".join([*path, last])
    names = sorted(str(name) for name in node)
    close = difflib.get_close_matches(last, names, n=1, cutoff=0.5)
    hint = f"did you mean {'.'.join([*path, close[0]])}?" if close else ""
    return f"{given.line}: there is no such key; {hint or 'there are ' + ', '.join(names)}"
