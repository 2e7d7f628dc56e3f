"""From overrides to points: Hydra composes; wrong input is answered before anything runs."""

import dataclasses
import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from typing import Any

from hydra import initialize_config_dir
from hydra.core.config_search_path import ConfigSearchPath
from hydra.core.global_hydra import GlobalHydra
from hydra.core.plugins import Plugins
from hydra.errors import HydraException
from hydra.plugins.search_path_plugin import SearchPathPlugin
from hydra.types import RunMode
from hydra.version import VersionBase, setbase
from omegaconf import OmegaConf
from omegaconf.errors import OmegaConfBaseException

from sphstudy import catalogue
from sphstudy.catalogue import solver_module
from sphstudy.configuration.execution import RETRIES, SETTINGS, Execution, taken
from sphstudy.configuration.overrides import (
    SEARCH_PATH,
    Grammar,
    applied,
    grid,
    launcher_overrides,
    rounded,
    searched,
)
from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.errors import ConfigurationError, unknown
from sphstudy.text import counted

LAUNCHERS = ("local", "basic", "slurm")
"""Side by side on this machine, one after the other in this process, jobs of a SLURM cluster."""

_GROUPS = ("scene", "method", "solve")
_ONE_AT_A_TIME = threading.Lock()
SECTIONS = ("title", "metrics", "headline", "protocol", "source", "bounds", "quoted")
"""Sections of a scene's file that are no settings of a run: the catalogue reads them."""


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


class _NotValid(ConfigurationError):
    """A point that was composed but does not make a run."""


class _OwnSettings(SearchPathPlugin):
    """Makes Hydra look into the user's folders of settings before the package's."""

    def manipulate_search_path(self, search_path: ConfigSearchPath) -> None:
        for place in reversed(catalogue.settings_folders()[:-1]):
            search_path.prepend("own", f"file://{place}", anchor="main")


@contextmanager
def session(config_dir: str | None = None) -> Iterator["Session"]:
    """A Session on the package's settings, and on those of the user.

    Parameters
    ----------
    config_dir : str, optional
        A folder of the user's with files of settings; it stays known to this process afterwards, since
        tables and pages ask for the lists of a scene.

    Raises
    ------
    ConfigurationError
        If there is no such folder.
    """
    if config_dir is not None:
        catalogue.add_settings(config_dir)
    yield Session()


@contextmanager
def _borrowed() -> Iterator[None]:
    """Hydra for this package alone. It is one in a process: a program that uses it for itself finds it as
    it was, and threads take turns.
    """
    with _ONE_AT_A_TIME:
        hydra, base = GlobalHydra.instance(), VersionBase.instance()
        before, hydra.hydra = hydra.hydra, None
        base_before = base.version_base
        setbase("1.3")
        try:
            yield
        finally:
            GlobalHydra.instance().hydra = before
            base.version_base = base_before


Plugins.instance().register(_OwnSettings)


class Session:
    """Hydra, ready to compose configurations (see `session`)."""

    def __init__(self) -> None:
        self._begin()

    def _begin(self) -> None:
        folder = str(catalogue.folder("conf").resolve())
        with _borrowed(), initialize_config_dir(folder, version_base="1.3", job_name="sphstudy"):
            self._loader = GlobalHydra.instance().config_loader()
        # Hydra looks through its folders every time it is asked.
        self._grammar = Grammar(cache(self._loader.get_group_options))
        self._composed: dict[tuple[str, ...], dict[str, Any]] = {}

    def search_path(self) -> list[str]:
        """Where Hydra looks for settings, the first place that has a file counting."""
        return [str(place.path) for place in self._loader.get_search_path().get_path()]

    def points(
        self, arguments: list[str], sweep: bool, skipped: list[str] | None = None
    ) -> tuple[list[Point], str]:
        """All points that overrides span, validated; of equal ones (h=1.3,1.30) the first, which is said.

        Parameters
        ----------
        arguments : list of str
            Overrides.
        sweep : bool
            Whether several values of a setting make several points; if not, they are an error.
        skipped : list of str, optional
            If given, points that are not valid are left out, and complaints about them added here.

        Returns
        -------
        list of Point, str
            The points, and the folder of their results.

        Raises
        ------
        ConfigurationError
            With all complaints about all points.
        """
        complaints: dict[str, None] = {}
        points: list[Point] = []
        results = set()
        for choice in self._grid(arguments, sweep):
            try:
                composed = self._composition(choice)
                results.add(str(composed.pop("results")))
                retry, execution = composed.pop("retry"), taken(composed)
                if retry not in RETRIES:
                    raise ConfigurationError([unknown("retry", retry, RETRIES)])
                config = _validated(composed)
                if complaint := _too_many(execution.threads, config):
                    raise ConfigurationError([complaint])
                points.append(Point(choice, config, execution, retry))
            except _NotValid as error:
                if skipped is None:
                    complaints |= dict.fromkeys(error.complaints)
                else:
                    skipped += error.complaints
            except ConfigurationError as error:
                complaints |= dict.fromkeys(error.complaints)
        if len(results) > 1:
            complaints["results: all points of a sweep need the same folder"] = None
        if complaints:
            raise ConfigurationError(list(complaints))
        unlike: dict[str, Point] = {}
        for point in points:
            unlike.setdefault(point.config.text, point)
        if (equal := len(points) - len(unlike)) > 0:
            print(f"{counted(equal, 'point')} left out, equal to others", file=sys.stderr)
        return list(unlike.values()), results.pop()

    def composed(self, arguments: list[str]) -> dict[str, Any]:
        """What overrides, of one value each, make of the settings; values are not validated.

        Raises
        ------
        ConfigurationError
            With all complaints about the overrides.
        """
        (choice,) = self._grid(arguments, sweep=False)
        return self._composition(choice)

    def launcher(self, overrides: list[str]) -> Launcher:
        """The launcher that overrides (as `launcher_overrides` returns them) choose and configure.

        Raises
        ------
        ConfigurationError
            If there is no such launcher or no such setting of it, or if n_jobs is wrong.
        """
        for override in overrides:
            key, _, value = override.partition("=")
            if key == "hydra/launcher" and value not in LAUNCHERS:
                raise ConfigurationError([unknown("launcher", value, LAUNCHERS)])
        try:
            with _borrowed():
                config = self._loader.load_configuration("config", overrides, RunMode.MULTIRUN)
        except HydraException as error:
            raise ConfigurationError([f"{' '.join(overrides)}: {error}".splitlines()[0]]) from None
        settings: Any = OmegaConf.to_container(config.hydra.launcher)
        jobs = settings.get("n_jobs")
        if jobs is not None and (type(jobs) is not int or (jobs < 1 and jobs != -1)):
            raise ConfigurationError(
                [f"hydra.launcher.n_jobs={jobs}: should be a whole number above 0, or -1: one per core"]
            )
        return Launcher(config.hydra.runtime.choices["hydra/launcher"], settings)

    def _grid(self, arguments: list[str], sweep: bool) -> list[tuple[str, ...]]:
        """The points that overrides span, those of a launcher and of the search path taken out."""
        places = [place for a in arguments if a.startswith(SEARCH_PATH) for place in searched(a)]
        if places:
            for place in places:
                catalogue.add_settings(place)
            self._begin()
        apart = {*launcher_overrides(arguments), *(a for a in arguments if a.startswith(SEARCH_PATH))}
        overrides = self._grammar.parsed([a for a in arguments if a not in apart])
        many = [o for o in overrides if o.is_sweep_override()]
        if many and not sweep:
            raise ConfigurationError(
                [f"{o.input_line}: several values make a sweep: add -m" for o in many]
            )
        return grid(overrides)

    def _composition(self, choice: tuple[str, ...]) -> dict[str, Any]:
        """The plain dictionary of one point. Files are composed once per choice of groups; single values
        are set on a copy.
        """
        try:
            settings = [self._grammar.setting(override) for override in choice]
            groups = tuple(one.line for one in settings if one.is_group)
            if groups not in self._composed:
                self._composed[groups] = self._files(list(groups))
        except (HydraException, OmegaConfBaseException) as error:
            raise ConfigurationError([f"{' '.join(choice)}: {str(error).splitlines()[0]}"]) from None
        return applied(settings, self._composed[groups])

    def _files(self, groups: list[str]) -> dict[str, Any]:
        """What the files of a choice of groups say, with the protocol of scene, method and solver."""
        with _borrowed():
            config = self._loader.load_configuration("config", groups, RunMode.RUN)
        names = [str(config.hydra.runtime.choices[group]) for group in _GROUPS]
        own = OmegaConf.create({k: config[k] for k in config if k != "hydra" and k not in SECTIONS})
        values: Any = OmegaConf.to_container(own, resolve=True)
        if strange := values.keys() - {*SETTINGS, *(f.name for f in dataclasses.fields(RunConfig))}:
            known = [*_GROUPS, "n", "h", "seed", "record", *SECTIONS]
            raise ConfigurationError([unknown(f"section of scene {names[0]}", s, known) for s in strange])
        for group, name in zip(_GROUPS, names, strict=True):
            if not isinstance(values.get(group), dict):
                raise ConfigurationError([f"{group}/{name}.yaml: sets nothing of the {group}"])
            values[group]["name"] = name
        values["method"].pop("protocol", None)
        return rounded(catalogue.merged(values, catalogue.protocol(*names)))


def _validated(composed: dict[str, Any]) -> RunConfig:
    try:
        return validate(composed)
    except ConfigurationError as error:
        raise _NotValid(error.complaints) from None


def _too_many(threads: int, config: RunConfig) -> str | None:
    """What is wrong with the number of threads of a run."""
    if threads == 1:
        return None
    if threads > (cores := os.cpu_count() or 1):
        return f"threads={threads}: this machine has {cores} cores"
    if not solver_module(config.solve.name).THREADS:
        return f"threads={threads}: solver {config.solve.name} runs on one thread"
    return None
