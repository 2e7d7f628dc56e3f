"""What `sphstudy study speed` takes, and what is answered to anything else."""

from dataclasses import dataclass

from sphstudy.errors import ConfigurationError

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

_KEYS = ("quick", "results", "rounds", "parts")


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


def parsed(overrides: list[str]) -> Settings:
    """The settings that key=value overrides make.

    Raises ConfigurationError with a line for each that is wrong.
    """
    values: dict[str, str] = {}
    complaints = []
    for override in overrides:
        key, _, value = override.partition("=")
        if key not in _KEYS:
            complaints.append(f"{override}: study speed takes {', '.join(f'{k}=' for k in _KEYS)}")
        elif key in values:
            complaints.append(f"{override}: {key} is given twice")
        values[key] = value
    parts = tuple(dict.fromkeys(values.get("parts", ",".join(PARTS)).strip("[]").split(",")))
    if wrong := [part for part in parts if part not in PARTS]:
        complaints.append(f"parts={','.join(wrong)}: there is {', '.join(PARTS)}")
    if (quick := values.get("quick", "false")) not in ("true", "false"):
        complaints.append(f"quick={quick}: should be true or false")
    rounds = values.get("rounds", "3" if quick == "true" else "5")
    if not (rounds.isascii() and rounds.isdigit() and 1 <= int(rounds) <= 1000):
        complaints.append(f"rounds={rounds}: should be a whole number from 1 to 1000")
    if not (results := values.get("results", "results")):
        complaints.append("results=: should be a folder")
    if complaints:
        raise ConfigurationError(complaints)
    ordered = tuple(part for part in PARTS if part in parts)
    return Settings(quick == "true", results, int(rounds), ordered)
