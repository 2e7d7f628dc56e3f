"""Claims about the vibrating plate (thesis 4.1, 5.1)."""

from collections.abc import Callable

import pandas as pd

from sphstudy.analysis.claims.claim import Finding, claim
from sphstudy.analysis.claims.reading import (
    PLATE,
    because,
    best_smoothing,
    cells,
    choices,
    count,
    everywhere,
    falls,
    finding,
    interval,
    signed,
    span,
    unstable,
    whole_grid,
    within,
)
from sphstudy.analysis.claims.tensile_instability import kernel_test, unstable_side
from sphstudy.analysis.results import Results
from sphstudy.metrics.roughness import VISIBLE
from sphstudy.text import percent

ERRORS = ("frequency", "amplitude")

FREQUENCY_RANGE = (-0.275, -0.025)
"""-0.25 (lowest tick of figure 4.2a) less half a tick, and -0.03 ("about 3 %") and half a per cent."""

AMPLITUDE_RANGE = (0.025, 0.35)
"""0.03 ("about 3 %") less half a per cent, and 0.3 (highest tick of figure 4.2b) and half a tick."""

ABOUT_3_PERCENT = (0.025, 0.035)
"""What rounds to 3 %."""

SPIKED, CLEAN = ((15, 1.3), (21, 1.3)), ((9, 1.3), (21, 1.5))
"""Cells (n, h̃) in which the thesis sees spikes and in which it sees none (figures 4.3 to 4.5)."""

DRAWN = ((21, 1.3), (21, 1.5))
"""The spikes and their absence that figures 4.3 and 4.4 show at the same resolution."""


def _in_range(
    results: Results,
    metric: str,
    sign: float,
    limits: tuple[float, float],
    cause: Callable[[pd.DataFrame], str],
) -> Finding:
    """The finding of "all of this sign and in this range"; cause: of the cells outside, as a mask."""
    errors = whole_grid(results, metric, PLATE)
    right, shaky = sign * errors > 0.0, unstable(results, errors)
    outside = ~within(errors, *limits) & ~shaky
    numbers = f"{count(right)} of {right.size} are {'positive' if sign > 0.0 else 'negative'}"
    numbers += f"; all: {span(errors)}"
    if shaky.any(axis=None):
        numbers += f"; without {cells(shaky)}, which are unstable: {span(errors.mask(shaky))}"
    if outside.any(axis=None):
        numbers += f"; outside the range: {cells(outside)}"
    everything = everywhere(right) and not outside.any(axis=None)
    return finding(everything, everywhere(right), numbers, "" if everything else cause(outside))


@claim(
    "V1",
    "All 12 frequency errors are negative, between about −0.25 and −0.03.",
    "section 4.1, figure 4.2a",
    reproduced=f"all negative, and all stable cells in {interval(FREQUENCY_RANGE)}",
    partly="all negative, but a stable cell lies outside that range",
    otherwise="a frequency error is positive",
)
def frequency_errors(results: Results) -> Finding:
    """Sign and range of the frequency errors."""
    cause = lambda outside: _frequency_cause(results)  # noqa: E731
    return _in_range(results, "frequency_error", -1.0, FREQUENCY_RANGE, cause)


def _frequency_cause(results: Results) -> str:
    """What the errors are against the right reference."""
    plane = whole_grid(results, "frequency_error_2d", PLATE)
    return (
        "ω0 is that of a beam in plane stress, and the plate is in plane strain: against 2-D "
        f"elasticity of the same plate the errors are {span(plane)}"
    )


@claim(
    "V2",
    "All 12 amplitude errors are positive, about 0.03 to above 0.3.",
    "section 4.1, figure 4.2b",
    reproduced=f"all positive, and all stable cells in {interval(AMPLITUDE_RANGE)}",
    partly="all positive, but a stable cell lies outside that range",
    otherwise="an amplitude error is negative",
)
def amplitude_errors(results: Results) -> Finding:
    """Sign and range of the amplitude errors."""
    cause = lambda outside: _amplitude_cause(results, outside)  # noqa: E731
    return _in_range(results, "amplitude_error", 1.0, AMPLITUDE_RANGE, cause)


def _amplitude_cause(results: Results, off: pd.DataFrame) -> str:
    """Amplitude and frequency are one error seen twice, but for lost energy; off: the cells to
    explain.
    """
    product = whole_grid(results, "amplitude_frequency_product", PLATE)
    lossless = (1.0 + whole_grid(results, "amplitude_error", PLATE)) / product - 1.0
    numbers = ", ".join(
        f"at ({n}, {h:g}) that is {signed(lossless.at[h, n])}, and "
        f"{signed(product.at[h, n] - 1.0)} by loss"
        for n in off
        for h in off.index
        if off.at[h, n]
    )
    return f"the tip starts with a given speed, so without loss of energy A = v_tip(0)/ω; {numbers}"


@claim(
    "V3",
    "The smallest error is about 3 % both for the frequency and for the amplitude.",
    "sections 4.1 and 5.1",
    reproduced=f"the smallest size of either lies in {interval(ABOUT_3_PERCENT, 100.0)} %",
    partly="that of one of the two does",
    otherwise="that of neither does",
)
def smallest_errors(results: Results) -> Finding:
    """The smallest errors, and where they are."""
    errors = {name: whole_grid(results, f"{name}_error", PLATE).abs() for name in ERRORS}
    least = {name: float(grid.min(axis=None)) for name, grid in errors.items()}
    where = {name: grid == least[name] for name, grid in errors.items()}
    lower, upper = ABOUT_3_PERCENT
    right = {name: lower <= value <= upper for name, value in least.items()}
    numbers = "; ".join(f"{name} {percent(least[name])} at {cells(where[name])}" for name in ERRORS)
    cause = because(
        "" if right["frequency"] else _frequency_cause(results),
        "" if right["amplitude"] else _amplitude_cause(results, where["amplitude"]),
    )
    return finding(all(right.values()), any(right.values()), numbers, cause)


@claim(
    "V4",
    "Errors fall as n grows, except at h̃ = 1.3, where they grow.",
    "section 4.1",
    reproduced="frequency and amplitude errors fall from 9 to 15 and from 15 to 21 rows at h̃ = "
    "1.5, 1.7 and 1.9, and grow in both steps at 1.3: sixteen comparisons",
    partly="all of those at h̃ = 1.5, 1.7 and 1.9 hold, not all at 1.3",
    otherwise="one of those at h̃ = 1.5, 1.7 and 1.9 fails",
)
def trends(results: Results) -> Finding:
    """Trends with the resolution."""
    fall = pd.concat([falls(whole_grid(results, f"{name}_error", PLATE)) for name in ERRORS], axis=1)
    smooth, rough = fall.drop(index=1.3), ~fall.loc[[1.3]]
    frequency = whole_grid(results, "frequency_error", PLATE).loc[1.3]
    numbers = (
        f"fall in {count(smooth)} of {smooth.size} steps at h̃ = 1.5 to 1.9, grow in {count(rough)} of "
        f"{rough.size} at 1.3 (frequency: {', '.join(map(signed, frequency))})"
    )
    cause = because(unstable_side(1.3), kernel_test(results, 1.3))
    return finding(everywhere(smooth) and everywhere(rough), everywhere(smooth), numbers, cause)


@claim(
    "V5",
    "h̃ = 1.5 is the best choice overall for the vibrating plate.",
    "section 4.1",
    reproduced="the mean size over the three resolutions is smallest at h̃ = 1.5, for frequency "
    "and amplitude",
    partly="for one of the two, or h̃ = 1.5 is the best in at least half of the six columns",
    otherwise="neither",
)
def best_smoothing_radius(results: Results) -> Finding:
    """Mean errors of each h̃."""
    errors = {name: whole_grid(results, f"{name}_error", PLATE).abs() for name in ERRORS}
    means = {name: grid.mean(axis=1) for name, grid in errors.items()}
    best = [mean.idxmin() == 1.5 for mean in means.values()]
    wins = sum(int((best_smoothing(grid) == 1.5).sum()) for grid in errors.values())
    numbers = "; ".join(
        f"{name}: " + ", ".join(f"{percent(value)} ({h:g})" for h, value in mean.items())
        for name, mean in means.items()
    )
    numbers = f"mean size over n: {numbers}; best in {wins} of 6 columns"
    cause = "best for the frequency at h̃ = " + choices(best_smoothing(errors["frequency"]))
    return finding(all(best), any(best) or wins >= 3, numbers, cause)


@claim(
    "V6",
    "Von Mises spikes below the axis near the wall at a quarter period for (n, h̃) = (21, 1.3) "
    "and (15, 1.3), none for (21, 1.5) and (9, 1.3); above the axis it looks a lot better.",
    "section 4.1, figures 4.3 to 4.5",
    reproduced=f"roughness below the axis is at least {VISIBLE:g} in the first two cells and less "
    "in the other two, and less above the axis in all four",
    partly="below the axis this holds for (21, 1.3) and (21, 1.5), which figures 4.3 and 4.4 show",
    otherwise="not even that",
)
def spikes(results: Results) -> Finding:
    """Roughness of the von Mises stress in the four cells."""
    bottom, top = (whole_grid(results, f"stress_roughness_{side}", PLATE) for side in ("bottom", "top"))
    right = {(n, h): (bottom.at[h, n] >= VISIBLE) == ((n, h) in SPIKED) for n, h in (*SPIKED, *CLEAN)}
    calm_above = all(top.at[h, n] < VISIBLE for n, h in right)
    numbers = ", ".join(
        f"{percent(bottom.at[h, n])} below and {percent(top.at[h, n])} above the axis at ({n}, {h:g})"
        for n, h in right
    )
    numbers = because(f"roughness {numbers}", kernel_test(results, 1.3))
    cause = because(unstable_side(1.3), unstable_side(1.5))
    return finding(all(right.values()) and calm_above, all(right[cell] for cell in DRAWN), numbers, cause)


@claim(
    "V7",
    "With artificial stress a von Mises disturbance appears at the bottom near the wall.",
    "section 4.1, figure 4.1 (h̃ and n are not given)",
    reproduced=f"at h̃ = 1.5 roughness below the axis reaches {VISIBLE:g} at one resolution at "
    "least, where it does not without artificial stress, and is larger than above the axis",
    partly="it stays below that, but artificial stress makes it larger at every resolution",
    otherwise="artificial stress does not make it larger everywhere",
)
def disturbance(results: Results) -> Finding:
    """Roughness with artificial stress against roughness without."""
    without = whole_grid(results, "stress_roughness_bottom", PLATE)
    disturbed, grown, numbers = [], [], []
    for n in PLATE:
        bottom, top = (
            results.value(f"stress_roughness_{side}", {"h": 1.5, "n": n}, "artificial")
            for side in ("bottom", "top")
        )
        plain = float(without.at[1.5, n])
        disturbed.append(plain < VISIBLE <= bottom and bottom > top)
        grown.append(bottom > plain)
        numbers.append(
            f"n = {n}: {percent(bottom)} below, {percent(top)} above, {percent(plain)} below without it"
        )
    cause = "the thesis does not say at which resolution, h̃ and time it saw the disturbance"
    return finding(any(disturbed), all(grown), "; ".join(numbers), cause)
