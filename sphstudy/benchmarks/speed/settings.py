"""What `sphstudy speed` measures, and its settings."""

from dataclasses import dataclass

from sphstudy.errors import ConfigurationError, unknown

PARTS = {
    "forms": "time per pair on lattices, cracked, perturbed, in random order",
    "growth": "time per pair from 1e3 to 1e6 particles (quick: to 1e5)",
    "terms": "what each term of a method costs, switched off and never there",
    "threads": "one run of 1e5 particles on one and two threads",
    "processes": "a sweep in one and two processes",
    "start": "loading, compiling and memory, in processes of their own",
    "runs": "whole runs: one period of the plate, modes, equilibrium",
}
"""What is measured, in this order."""


@dataclass(frozen=True)
class Settings:
    """quick: fewer and shorter measurements, for a first look. rounds: turns of each variant.

    slice_seconds: CPU time of one turn. parts: which of PARTS. results: folder.
    """

    quick: bool = False
    results: str = "results"
    rounds: int = 5
    parts: tuple[str, ...] = tuple(PARTS)

    @property
    def slice_seconds(self) -> float:
        """CPU seconds that one turn of a rate is meant to take."""
        return 0.03 if self.quick else 0.2


def chosen(options: dict[str, str]) -> Settings:
    """The settings that options of the command line make.

    Parameters
    ----------
    options : dict
        Values of quick, results, rounds and parts, as far as they are given.

    Raises
    ------
    ConfigurationError
        With a line for each that is wrong.
    """
    complaints = []
    parts = tuple(dict.fromkeys(options.get("parts", ",".join(PARTS)).strip("[]").split(",")))
    complaints += [unknown("part", part, PARTS) for part in parts if part not in PARTS]
    quick = options.get("quick") == "true"
    rounds = options.get("rounds", "3" if quick else "5")
    if not (rounds.isascii() and rounds.isdigit() and 1 <= int(rounds) <= 1000):
        complaints.append(f"rounds={rounds}: should be a whole number from 1 to 1000")
    if complaints:
        raise ConfigurationError(complaints)
    ordered = tuple(part for part in PARTS if part in parts)
    return Settings(quick, options.get("results", "results"), int(rounds), ordered)
