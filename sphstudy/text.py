"""Numbers, units and settings as text for people: few digits, real minus signs, powers of ten."""

import hashlib
import math
import re
from typing import Any

NOTHING = "–"
"""Stands where there is no value."""

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_THIN = "\N{NARROW NO-BREAK SPACE}"


def number(value: float, digits: int = 4, sign: bool = False) -> str:
    """A number as text; NOTHING for NaN.

    Parameters
    ----------
    value : float
        The number. Whole numbers are written out.
    digits : int
        Significant digits.
    sign : bool
        Whether a positive number has a plus sign.
    """
    if math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "−∞" if value < 0 else "∞"
    text = _whole(value) or _rounded(value, digits)
    if sign and value > 0:
        text = f"+{text}"
    return text.replace("-", "−").replace(",", _THIN)


def _whole(value: float) -> str:
    return f"{value:,.0f}" if value == int(value) and abs(value) < 1e15 else ""


def _rounded(value: float, digits: int) -> str:
    # The exponent of the rounded number: 0.09999 becomes 0.1000, not 0.10000.
    mantissa, _, power = f"{value:.{digits - 1}e}".partition("e")
    exponent = int(power)
    if -4 <= exponent < 6:
        return f"{value:,.{max(0, digits - 1 - exponent)}f}"
    return f"{mantissa}×10{str(exponent).translate(_RAISED)}"


def percent(value: float, digits: int = 3, sign: bool = False) -> str:
    """A share in per cent with its unit; parameters as those of `number`."""
    return NOTHING if math.isnan(value) else f"{number(100.0 * value, digits, sign)} %"


def with_uncertainty(value: float, uncertainty: float) -> str:
    """A value ± its uncertainty, which has two digits; NOTHING for NaN.

    Parameters
    ----------
    value, uncertainty : float
        Both in the same unit. Without an uncertainty the value has six digits.
    """
    if math.isnan(value):
        return NOTHING
    if not uncertainty > 0.0:
        return f"{value:.6g} ± {uncertainty:.2g}"
    # The first two digits as they come out rounded: 0.0996 is 0.10.
    digits = 1 - int(f"{uncertainty:.1e}".partition("e")[2])
    if digits > 6:
        most = max(abs(value), uncertainty)
        return f"{value:.{max(digits + math.floor(math.log10(most)), 1)}e} ± {uncertainty:.1e}"
    value, uncertainty = round(value, digits), round(uncertainty, digits)
    return f"{value:.{max(digits, 0)}f} ± {uncertainty:.{max(digits, 0)}f}"


def is_share(name: str, units: str) -> bool:
    """Whether the metric of this name and stored unit is a relative error, which is shown in %."""
    return units == "1" and "error" in name.split("_")


def metric(name: str, value: float, units: str, sign: bool = False) -> str:
    """The value of a metric, in the unit that `unit` gives.

    Parameters
    ----------
    name, units : str
        Of the metric, as they are stored.
    value : float
        The value in `units`.
    sign : bool
        Whether it is a change, which has a sign and three digits instead of four.
    """
    if is_share(name, units):
        return number(100.0 * value, 3, sign)
    return number(value, 3 if sign else 4, sign)


def unit(name: str, units: str) -> str:
    """The unit in which `metric` writes the metric of this name and stored unit; "" for a pure number."""
    if is_share(name, units):
        return "%"
    return "" if units == "1" else re.sub(r"-?\d+", lambda power: power[0].translate(_RAISED), units)


def heading(name: str, units: str) -> str:
    """The heading of the column of the metric of this name and stored unit."""
    shown = unit(name, units)
    # The unit says that it is in seconds.
    words = name.removesuffix("_seconds").replace("cpu", "CPU").replace("_", " ")
    return words + (f" ({shown})" if shown else "")


def setting(value: Any) -> str:
    """The value of a setting as the command line takes it."""
    if isinstance(value, list):
        return f"[{', '.join(map(setting, value))}]"
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "null"}[value]
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def duration(seconds: float, digits: int = 3) -> str:
    """A time span (s) with that many digits, in seconds, minutes or hours, whichever suits it."""
    for size, name in ((3600.0, "h"), (60.0, "min")):
        if seconds >= 2.0 * size:
            return f"{number(seconds / size, digits)} {name}"
    return f"{number(seconds, digits)} s"


def short_name(name: str, longest: int = 120) -> str:
    """A name of a file; the end of one that is too long for a file system is replaced by its hash."""
    if len(name.encode()) <= longest:
        return name
    digest = hashlib.sha256(name.encode()).hexdigest()[:8]
    return name.encode()[: longest - 9].decode(errors="ignore") + f"-{digest}"


def counted(count: int, noun: str) -> str:
    """A count with its noun: "1 point", "3 points"."""
    return f"{number(count)} {noun}{'' if count == 1 else 's'}"
