"""What the program refuses, in words for whoever asked."""

import difflib
from collections.abc import Iterable


class ConfigurationError(ValueError):
    """Wrong input.

    Parameters
    ----------
    complaints : list of str
        One line each, naming key, value and what is allowed.
    """

    def __init__(self, complaints: list[str]):
        super().__init__("\n".join(complaints))
        self.complaints = complaints


def unknown(what: str, name: object, known: Iterable[str]) -> str:
    """The complaint about a name that does not exist.

    Parameters
    ----------
    what : str
        What the name is of: "scene", "setting", "study".
    name : object
        What was given.
    known : iterable of str
        All names that exist.

    Returns
    -------
    str
        "unknown scene 'foo'; did you mean 'foil'? There are bar, foil"
    """
    names = [str(one) for one in known]
    close = difflib.get_close_matches(str(name), names, n=1, cutoff=0.5)
    hint = f"did you mean '{close[0]}'? There are" if close else "there are"
    given = str(name) if len(str(name)) <= 100 else f"{str(name)[:100]}…"
    return f"unknown {what} '{given}'; {hint} {', '.join(names)}"
