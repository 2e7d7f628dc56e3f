"""From the arguments of the command line to a request, or to help. The one place that knows argparse."""

import argparse
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NoReturn

from sphstudy.commands.grammar import COMMANDS, Command, about
from sphstudy.errors import ConfigurationError, unknown

OVERVIEW = """\
sphstudy - batch studies with smoothed particle hydrodynamics of elastic
solids and fracture

  sphstudy h=1.5 n=40                one run (scene=mode1 method=thesis)
  sphstudy -m h=1.3,1.5 n=40,50,60   a sweep: every combination, in parallel
  sphstudy study mode1               a named study: runs, comparison, page

commands (each has its own --help):
{commands}

settings (key=value; several values with commas make a sweep with -m):
  scene=NAME method=NAME solve=NAME  what, how discretised, how solved
  h=1.5 n=40                         relative smoothing radius; resolution
  scene.E=2e6 solve.courant=0.4      anything that `describe` shows
  record.times=[1.5]                 when fields are kept (s)
  results=FOLDER                     where records go (default: results)
  checkpoint=60                      seconds between checkpoints of a run
  threads=2                          of one long run: the same bits, sooner
  hydra.launcher.n_jobs=4            runs at once (default: one per core)
  hydra/launcher=slurm               as jobs of a cluster; basic: one by one
  time_limit=600 memory_limit=2      of a run (s, GiB): timeout, failed
  retry=failed                       run these again (timeout, all)

options of a run:
{options}
  -h, --help                         this text, or that of a command
  --version                          the version

A run that is stored is not run again. Exit status: 0 all points done (a
diverged point is a result), 1 a point failed or has no record, the disk takes
no more, or a metric lies outside its accepted interval, 2 wrong input, 130
interrupted, 141 nobody reads the output any more (finished runs are kept).
"""

_HELP = ("-h", "--help")
_INSTEAD = {"cfg": "composed", "info": "composed", "shell-completion": "completion"}
"""Modules that answer an option of `run` in its place."""

_NOT_TAKEN = {
    ("--hydra-help",): "write --help",
    ("--run", "-r"): "leave it out: without -m there is one run",
    ("--resolve",): "leave it out: --cfg job prints values resolved",
    ("--package", "-p"): "leave it out: --cfg job prints all settings",
    ("--config-path", "-cp"): "write --config-dir DIR, which adds a folder of settings",
    ("--config-name", "-cn"): "write key=value; scene=NAME of your own with --config-dir DIR",
    ("--experimental-rerun",): "repeat the command; --force runs again what is stored",
}
"""Options of Hydra that have no place here, and what is written instead."""


@dataclass(frozen=True)
class Request:
    """What a command line asks for.

    Attributes
    ----------
    name, module : str
        The command, and the module of this folder that does it.
    words : tuple of str
        Study, files, metrics: what is neither an option nor a setting.
    settings : tuple of str
        Settings of runs, `key=value`.
    options : dict
        Values of the options given, by name; "true" for a switch.
    """

    name: str
    module: str
    words: tuple[str, ...]
    settings: tuple[str, ...]
    options: dict[str, str]

    def has(self, switch: str) -> bool:
        """Whether a switch is on."""
        return self.options.get(switch) == "true"

    @property
    def results(self) -> str:
        """Folder of the results."""
        return self.options.get("results", "results")

    @property
    def config_dir(self) -> str | None:
        """The user's folder of settings."""
        return self.options.get("config-dir")

    def number(self, option: str, default: float, least: float, most: float = math.inf) -> float:
        """The value of an option as a number.

        Parameters
        ----------
        option : str
            Its name.
        default : float
            Value if the option is not given.
        least, most : float
            What is allowed.

        Raises
        ------
        ConfigurationError
            If it is not a finite number within these limits.
        """
        text = self.options.get(option, str(default))
        try:
            if math.isfinite(value := float(text)) and least <= value <= most:
                return value
        except ValueError:
            pass
        limits = f"from {least:g} to {most:g}" if math.isfinite(most) else f"not below {least:g}"
        raise ConfigurationError([f"--{option}={text}: should be a number {limits}"])

    def misused(self) -> ConfigurationError:
        """The complaint that says how the command is written."""
        ways = " or ".join(line.strip() for line in about(self.name)[1].splitlines())
        return ConfigurationError([f"{self.name}: write {ways}"])


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        told = message.removeprefix("argument ").replace("expected one argument", "lacks its value")
        raise ConfigurationError([f"{told} (see {self.prog} --help)"])


def parse(arguments: list[str]) -> Request:
    """What a command line asks for.

    Parameters
    ----------
    arguments : list of str
        The arguments of the program.

    Raises
    ------
    ConfigurationError
        With what is wrong in its form, and what to write instead.
    """
    name, rest = _command(arguments)
    command = COMMANDS[name]
    given, other = _parser(name).parse_known_args(rest)
    complaints = list(_unknown_options(name, command, [o for o in other if o.startswith("-")]))
    options: dict[str, list[str]] = {key.replace("_", "-"): v for key, v in vars(given).items() if v}
    words, settings = [], []
    names = {option.name for option in command.options}
    for word in [o for o in other if not o.startswith("-")]:
        key, equals, value = word.partition("=")
        if equals and key in names and not (command.settings and key != "results"):
            options.setdefault(key, []).append(value)
        elif equals and command.settings:
            settings.append(word)
        elif equals and key.isidentifier():
            complaints.append(f"{word}: {unknown(f'option of {name}', key, sorted(names))}")
        else:
            words.append(word)
    if complaints:
        raise ConfigurationError(complaints)
    module = next((module for option, module in _INSTEAD.items() if option in options), name)
    found = Request(name, module, tuple(words), tuple(settings), dict(_single(options)))
    _check(found, command)
    if command.settings and "results" in options:
        found = replace(found, settings=(*settings, f"results={found.results}"))
    return found


def _command(arguments: list[str]) -> tuple[str, list[str]]:
    """The command and its arguments; without the word of one it is `run`."""
    name, rest = arguments[0], arguments[1:]
    if name in COMMANDS:
        words = [a for a in rest if not a.startswith("-") and "=" not in a]
        if name == "study" and words[:1] == ["speed"]:
            rest.remove("speed")
            return "speed", rest
        return name, rest
    if name.startswith("-") or "=" in name:
        return "run", arguments
    from sphstudy.configuration import study_file

    if name in study_file.names():
        raise ConfigurationError([f"{name}: is a study; write sphstudy study {name}"])
    raise ConfigurationError([f"{unknown('command', name, COMMANDS)} (see sphstudy --help)"])


def _parser(name: str) -> argparse.ArgumentParser:
    found = _Parser(
        f"sphstudy {name}",
        usage=argparse.SUPPRESS,
        formatter_class=lambda prog: argparse.HelpFormatter(prog, max_help_position=37, width=79),
        add_help=False,
        allow_abbrev=False,
    )
    for option in COMMANDS[name].options:
        meaning = option.meaning.replace("%", "%%")
        if option.value:
            found.add_argument(*option.spellings, action="append", metavar=option.value, help=meaning)
        else:
            found.add_argument(*option.spellings, action="store_const", const=["true"], help=meaning)
    return found


def _unknown_options(name: str, command: Command, given: list[str]) -> Iterator[str]:
    """A complaint about each option that the command does not have."""
    for argument in given:
        flag = argument.partition("=")[0]
        instead = next((text for flags, text in _NOT_TAKEN.items() if flag in flags), None)
        owners = [n for n, c in COMMANDS.items() if any(flag in o.spellings for o in c.options)]
        if instead and name == "run":
            yield f"{flag}: an option of Hydra that is not taken here; {instead}"
        elif owners:
            yield f"{flag}: goes with {', '.join(owners)}, not with {name}"
        else:
            known = [spelling for option in command.options for spelling in option.spellings]
            yield unknown(f"option of {name}", flag, [*known, "--help"])


def _single(options: dict[str, list[str]]) -> Iterator[tuple[str, str]]:
    for key, values in options.items():
        if len(values) > 1:
            raise ConfigurationError([f"{key}: is given twice"])
        if not values[0]:
            raise ConfigurationError([f"{key}=: lacks its value"])
        yield key, values[0]


def _check(request: Request, command: Command) -> None:
    """Raises ConfigurationError if switches have other values than true and false, or words are too few
    or too many.
    """
    switches = {option.name for option in command.options if not option.value}
    for key, value in request.options.items():
        if key in switches and value not in ("true", "false"):
            raise ConfigurationError([f"{key}={value}: should be true or false"])
    count = len(request.words)
    if not count and command.least == 1 and (command.settings or request.name == "reference"):
        from sphstudy.configuration import study_file

        raise ConfigurationError([f"{request.name}: name one of {', '.join(study_file.names())}"])
    if command.settings and count > command.most:
        word = request.words[command.most]
        hint = f"a command comes first: sphstudy {word} …" if word in COMMANDS else "write key=value"
        raise ConfigurationError([f"{word}: neither an option of {request.name} nor a setting; {hint}"])
    if not command.least <= count <= command.most:
        raise request.misused()


def help_text(arguments: list[str]) -> str | None:
    """The help that arguments ask for: of a command, or of all; None if they ask for none.

    Parameters
    ----------
    arguments : list of str
        The arguments of the program; the help is also the answer to none.
    """
    if arguments and not set(_HELP) & set(arguments):
        return None
    name = arguments[0] if arguments else ""
    if name in COMMANDS:
        parser = _parser(name)
        parser.add_argument(*_HELP, action="help", help="this text")
        return "\n\n".join([*about(name), parser.format_help()])
    commands = [f"  {name:12s} {about(name)[0]}" for name in COMMANDS]
    options = _parser("run").format_help().partition("\n")[2].rstrip()
    return OVERVIEW.format(commands="\n".join(commands), options=options)
