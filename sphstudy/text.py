"""Numbers, units and settings as text for people: few digits, real minus signs, powers of ten."""

import math
import re
from typing import Any

NOTHING = "–"
"""Stands where there is no value."""

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_THIN = "\N{NARROW NO-BREAK SPACE}"


def number(value: float, digits: int = 4, sign: bool = False) -> str:
    """A number with so many significant digits, thousands set apart; `sign`: a plus if it is positive."""
    if math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "−∞" if value < 0 else "∞"
    text = _whole(value) or _rounded(value, digits)
    if sign and value > 0:
        text = f"+{text}"
    return text.replace("-", "−").replace(",", _THIN)


def _whole(value: float) -> str:
    """Counts are written out."""
    return f"{value:,.0f}" if value == int(value) and abs(value) < 1e15 else ""


def _rounded(value: float, digits: int) -> str:
    # The exponent of the rounded number: 0.09999 becomes 0.1000, not 0.10000.
    mantissa, _, power = f"{value:.{digits - 1}e}".partition("e")
    exponent = int(power)
    if -4 <= exponent < 6:
        return f"{value:,.{max(0, digits - 1 - exponent)}f}"
    return f"{mantissa}×10{str(exponent).translate(_RAISED)}"


def is_share(name: str, units: str) -> bool:
    """Whether a metric is a relative error, which is shown in %."""
    return units == "1" and "error" in name.split("_")


def metric(name: str, value: float, units: str, sign: bool = False) -> str:
    """The value of a metric, in % if it is a relative error; `sign`: it is a change, with its sign."""
    if is_share(name, units):
        return number(100.0 * value, 3, sign)
    return number(value, 3 if sign else 4, sign)


def unit(name: str, units: str) -> str:
    """The unit in which `metric` gives this one, empty for a pure number."""
    if is_share(name, units):
        return "%"
    return "" if units == "1" else re.sub(r"-?\d+", lambda power: power[0].translate(_RAISED), units)


def heading(name: str, units: str) -> str:
    """Name and unit of a metric, as the heading of a column."""
    shown = unit(name, units)
    # What is in seconds need not say so twice.
    words = name.removesuffix("_seconds").replace("cpu", "CPU").replace("_", " ")
    return words + (f" ({shown})" if shown else "")


def setting(value: Any) -> str:
    """The value of a setting as one would write it on the command line."""
    if isinstance(value, list):
        return f"[{', '.join(map(setting, value))}]"
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "null"}[value]
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def duration(seconds: float) -> str:
    """A time span in the unit that suits it."""
    for size, name in ((3600.0, "h"), (60.0, "min")):
        if seconds >= 2.0 * size:
            return f"{number(seconds / size, 3)} {name}"
    return f"{number(seconds, 3)} s"


def counted(count: int, noun: str) -> str:
    """A count with its noun: "1 point", "3 points"."""
    return f"{number(count)} {noun}{'' if count == 1 else 's'}"
