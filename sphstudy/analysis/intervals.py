"""How far a metric may be from its reference: half of the smallest effect that any open choice has.

Such an interval tells two variants of a method apart, and leaves room for another machine's rounding: its
size is measured by the control of the choices study.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from sphstudy.analysis.effects import Effect

SHARE = 0.5
"""Half-width of an interval in smallest effects."""

ABOVE_ROUNDING = 100.0
"""An effect counts if it is this many times larger than the control's."""

ROUNDING = 1e-9
"""Half-width, relative to the largest value, of a metric that no choice has an effect on."""


@dataclass(frozen=True)
class Tolerance:
    """Half-width of a metric's accepted interval (its unit), and the reason in words."""

    half_width: float
    reason: str


def tolerances(found: Iterable[Effect]) -> dict[str, Tolerance]:
    """The tolerance of each metric.

    Parameters
    ----------
    found : iterable of Effect
        Effects of choices, of any blocks; a control counts for its own block.

    Returns
    -------
    dict
        Metric: its tolerance.
    """
    by_metric: dict[str, list[Effect]] = {}
    for effect in found:
        by_metric.setdefault(effect.metric, []).append(effect)
    return {metric: _tolerance(several) for metric, several in by_metric.items()}


def _tolerance(found: list[Effect]) -> Tolerance:
    noise: dict[str, float] = {}
    for effect in found:
        if effect.is_control:
            noise[effect.block] = max(abs(effect.change), noise.get(effect.block, 0.0))
    scale = max(max(abs(effect.base), abs(effect.value)) for effect in found)
    least = max(max(noise.values(), default=0.0) * ABOVE_ROUNDING, ROUNDING * scale)
    counted = [
        effect
        for effect in found
        if not effect.is_control
        and abs(effect.change) > max(ABOVE_ROUNDING * noise.get(effect.block, 0.0), ROUNDING * scale)
    ]
    if not counted:
        return Tolerance(least, "no open choice has an effect on it: rounding only")
    smallest = min(counted, key=lambda effect: abs(effect.change))
    return Tolerance(
        SHARE * abs(smallest.change),
        f"half of the smallest effect of an open choice: {abs(smallest.change):.2g} by "
        f"{smallest.varied} in {smallest.block}",
    )
