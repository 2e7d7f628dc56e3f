"""What a claim is: a sentence that somebody wrote, and the rule that checks it on stored results.

A rule is a function in a module of `sphstudy.analysis.claims`, decorated by `claim`: it takes the Results
of the study whose file names the claim's id, and returns a Finding, or raises Missing where the store
lacks what it needs.
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
    """A claim: id, sentence, where it stands, and what each of the first three verdicts means for it."""

    id: str
    text: str
    source: str
    meaning: dict[str, str]
    rule: Callable[[Results], Finding]

    def check(self, results: Results) -> Finding:
        """The rule's finding; UNKNOWN and why, if the store lacks what it needs or it fails."""
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
    """Decorator: makes a Claim of its rule.

    Parameters
    ----------
    id, text, source : str
        Its name in study files, the sentence, and where it stands.
    reproduced, partly, otherwise : str
        What the verdicts `reproduced`, `partly` and `not reproduced` mean for it.
    """
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
    """The claim with this id; raises ConfigurationError if there is none."""
    if id not in every_claim():
        raise ConfigurationError([unknown("claim", id, every_claim())])
    return every_claim()[id]


def checked(results: Results) -> list[tuple[Claim, Finding]]:
    """Checks every claim of the study, and of those that it includes and shows."""
    names = dict.fromkeys([*study_file.members(results.name), *results.definition.shows])
    return [
        (found, found.check(results.other(name)))
        for name in names
        for found in map(find, study_file.load(name).claims)
    ]
