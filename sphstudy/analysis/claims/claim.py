"""What a claim is: a sentence that somebody made, and the rule that checks it on stored results.

A study file names its claims by id; every module of `sphstudy.analysis.claims` is searched for them.
"""

import importlib
import pkgutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from sphstudy.analysis import claims
from sphstudy.analysis.results import Missing, Results
from sphstudy.configuration import study_file
from sphstudy.errors import ConfigurationError, unknown

REPRODUCED, PARTLY, NOT, UNKNOWN = "reproduced", "partly", "not reproduced", "no data"
"""Verdicts. UNKNOWN: the store lacks what the rule needs."""


@dataclass(frozen=True)
class Finding:
    """Verdict, the numbers behind it in words, and the likely cause where it is not `reproduced`."""

    verdict: str
    numbers: str
    cause: str = ""


@dataclass(frozen=True)
class Claim:
    """A claim: id, what was said, where, and what the verdicts mean for it (keys: the first three)."""

    id: str
    text: str
    source: str
    meaning: dict[str, str]
    rule: Callable[[Results], Finding]

    def check(self, results: Results) -> Finding:
        """The finding; UNKNOWN, and why, if the store lacks what the rule needs or the rule fails."""
        try:
            return self.rule(results)
        except Missing as missing:
            return Finding(UNKNOWN, str(missing))
        except Exception as error:
            # One rule that fails must not cost the report of a night's runs.
            print(f"claim {self.id}: {type(error).__name__}: {error}", file=sys.stderr)
            return Finding(UNKNOWN, f"the rule failed: {type(error).__name__}: {error}")


def claim(
    id: str, text: str, source: str, *, reproduced: str, partly: str, otherwise: str
) -> Callable[[Callable[[Results], Finding]], Claim]:
    """Decorator: makes a Claim of its rule. `otherwise`: what `not reproduced` means."""
    meaning = {REPRODUCED: reproduced, PARTLY: partly, NOT: otherwise}
    return lambda rule: Claim(id, text, source, meaning, rule)


@cache
def every_claim() -> dict[str, Claim]:
    """All claims of the package, by id, in the order of their modules."""
    found: dict[str, Claim] = {}
    for module in pkgutil.iter_modules(claims.__path__):
        members = vars(importlib.import_module(f"sphstudy.analysis.claims.{module.name}")).values()
        found |= {member.id: member for member in members if isinstance(member, Claim)}
    return found


def find(id: str) -> Claim:
    """The claim with this id. Raises ConfigurationError if there is none."""
    if id not in every_claim():
        raise ConfigurationError([unknown("claim", id, every_claim())])
    return every_claim()[id]


def checked(results: Results) -> list[tuple[Claim, Finding]]:
    """Every claim of the study, and of those that it includes and shows, with what came out."""
    names = dict.fromkeys([*study_file.members(results.name), *results.definition.shows])
    return [
        (found, found.check(results.other(name)))
        for name in names
        for found in map(find, study_file.load(name).claims)
    ]
