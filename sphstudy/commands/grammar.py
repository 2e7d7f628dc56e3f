"""What each command takes. `commands/<name>.py` has its help as docstring, and `run(request)`."""

import ast
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Option:
    """An option: `--name VALUE`, or `--name` alone where it has no value (a switch).

    Attributes
    ----------
    name, meaning : str
        Without dashes; and what the help says.
    value : str
        What stands for its value in the help; "" for a switch.
    short : str
        Another spelling.
    """

    name: str
    meaning: str
    value: str = ""
    short: str = ""

    @property
    def spellings(self) -> list[str]:
        """As they are typed."""
        return [*filter(None, [self.short]), f"--{self.name}"]


@dataclass(frozen=True)
class Command:
    """What a command takes.

    Attributes
    ----------
    options : tuple of Option
        Its options.
    least, most : int
        How many words it takes beside options and settings: a study, files, metrics.
    settings : bool
        Whether it takes settings of runs, `key=value`.
    """

    options: tuple[Option, ...] = ()
    least: int = 0
    most: int = 0
    settings: bool = False


_RESULTS = Option("results", "folder of the results (default: results)", "FOLDER")
_FORCE = Option("force", "run again what is stored, from the start", short="-f")
_DRY = Option("dry-run", "only tell what would be done, and what it costs")
_OWN = Option("config-dir", "find settings (scene/NAME.yaml, …) in it too", "DIR", "-cd")
_METHOD, _SOLVE = (Option(name, f"only this {name}", "NAME") for name in ("method", "solve"))
_OF_A_STUDY = Command((_RESULTS, _OWN), least=1, most=1, settings=True)

COMMANDS = {
    "run": Command(
        (
            Option("multirun", "run every combination of the values given", short="-m"),
            _FORCE,
            _RESULTS,
            _OWN,
            Option("cfg", "print the settings as YAML, run nothing", "job", "-c"),
            Option("info", "print the folders of settings", "searchpath", "-i"),
            Option("shell-completion", "for eval in bash", "install=bash", "-sc"),
        ),
        settings=True,
    ),
    "study": Command((_FORCE, _DRY, _RESULTS, _OWN), least=1, most=1, settings=True),
    "report": _OF_A_STUDY,
    "compare": Command(
        (
            Option("tolerance", "relative difference of files that is accepted (1e-6)", "T"),
            Option("all", "print all rows, not only the 20 worst"),
            _RESULTS,
        ),
        least=1,
        most=2,
    ),
    "judge": _OF_A_STUDY,
    "measure": _OF_A_STUDY,
    "reference": Command((_RESULTS,), least=1, most=1),
    "extrapolate": Command(
        (
            Option("order", "order of convergence; observed if it is not given", "P"),
            Option("output", "keep the result in a new netCDF file", "FILE"),
            Option("overwrite", "replace that file if it is there"),
            _RESULTS,
        ),
        least=2,
        most=1000,
    ),
    "advise": Command(
        (
            Option("scene", "the scene", "NAME"),
            Option("error", "relative error to be reached, as 0.001 or 0.1%", "E"),
            _METHOD,
            _SOLVE,
            Option("metric", "another error than the usual one of the scene", "NAME"),
            Option("study", "whose points (default: precision)", "NAME"),
            _RESULTS,
        )
    ),
    "status": Command((_RESULTS, _OWN), most=1, settings=True),
    "adopt": Command((_RESULTS,)),
    "prune": Command((Option("yes", "remove what is stale"), _RESULTS)),
    "list": Command(),
    "describe": Command(least=1, most=2),
    "speed": Command(
        (
            Option("quick", "fewer and shorter measurements"),
            Option("parts", "forms, growth, terms, threads, processes, start, runs", "PART,..."),
            Option("rounds", "turns of each variant (5; quick: 3)", "K"),
            _DRY,
            _RESULTS,
        )
    ),
    "peers": Command(
        (
            Option("peers", "which of pysph, lammps, skfem (all)", "NAME,..."),
            Option("n", "resolutions of the plate (9,15)", "N,..."),
            Option("repeats", "how often each run is timed (3)", "K"),
            _DRY,
            _RESULTS,
        )
    ),
}
"""By name, in the order of the help."""


def about(command: str) -> list[str]:
    """Paragraphs of a command's help: a line, how it is written, what it does, examples.

    Parameters
    ----------
    command : str
        Its name. Its module is read, not imported, which would take seconds.
    """
    source = Path(__file__).with_name(f"{command}.py").read_text(encoding="utf-8")
    return (ast.get_docstring(ast.parse(source)) or "").split("\n\n")
