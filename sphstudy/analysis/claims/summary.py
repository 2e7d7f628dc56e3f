"""Claims about all benchmarks together (thesis 5.4 to 6)."""

import pandas as pd

from sphstudy.analysis.claims.claim import Finding, claim
from sphstudy.analysis.claims.error_norms import DISPLACEMENTS, STRESSES, norms
from sphstudy.analysis.claims.reading import (
    CRACK,
    PLATE,
    because,
    cells,
    count,
    everywhere,
    finding,
    signed,
    whole_grid,
)
from sphstudy.analysis.claims.tensile_instability import FULL, THOUSANDTH, plate_test
from sphstudy.analysis.results import Results
from sphstudy.metrics.roughness import VISIBLE
from sphstudy.text import number, percent

FAR_BETTER = 3.0
"""Ratio of errors from which on projection is far better than propagation."""

GOOD = 2.0
"""Largest ratio of the mean error at h̃ = 1.5 to that at the best h̃ for a good choice ..."""

NEGLIGIBLE = 0.01
"""... unless it is a relative error below 1 %, which leaves nothing to choose."""


@claim(
    "S1",
    "h̃ of about 1.5 is a good choice throughout, and G2 (projection) is far better than G1 "
    "(propagation).",
    "sections 5.3, 5.4 and 6",
    reproduced=f"in all 24 cells of both modes the error of G1 is at least {FAR_BETTER:g} times "
    "that of G2; and for each of 14 measures (plate: frequency and amplitude; each mode: G2, five "
    f"norms) the mean error over n at h̃ = 1.5 is at most {GOOD:g} times that of the best h̃, or "
    f"below {percent(NEGLIGIBLE)}",
    partly="one of the two holds, or the first holds for the median of each mode and the second "
    "for at least 7 measures",
    otherwise="not even that",
)
def recommendations(results: Results) -> Finding:
    """Ratios of G1's errors to G2's, and of the errors at h̃ = 1.5 to the smallest."""
    ratios = {mode: _ratio(results.other(mode)) for mode in ("mode1", "mode2")}
    measures = _measures(results)
    mean = {name: grid.abs().mean(axis=1) for name, grid in measures.items()}
    regret = {name: float(m[1.5] / m.min()) for name, m in mean.items()}
    shares = [name for name in measures if name.endswith("error")]
    good = {
        name: times <= GOOD or (name in shares and mean[name][1.5] < NEGLIGIBLE)
        for name, times in regret.items()
    }
    better = [everywhere(grid >= FAR_BETTER) for grid in ratios.values()]
    typical = [float(grid.stack().median()) for grid in ratios.values()]
    mostly = min(typical) >= FAR_BETTER and 2 * sum(good.values()) >= len(good)
    numbers = (
        f"|G1 error|/|G2 error|: median {number(typical[0], 2)} in mode I, {number(typical[1], 2)} "
        f"in mode II; h̃ = 1.5 good in {sum(good.values())} of {len(good)} measures, best in "
        f"{sum(m.idxmin() == 1.5 for m in mean.values())}"
    )
    near = {mode: grid < FAR_BETTER for mode, grid in ratios.items() if count(grid < FAR_BETTER)}
    cause = because(
        *(
            f"{mode}: G1 comes closer than a factor of {FAR_BETTER:g} at {cells(mask)}"
            for mode, mask in near.items()
        ),
        *(f"{name} {number(regret[name], 2)} times the best" for name, fine in good.items() if not fine),
    )
    everything = all(better) and all(good.values())
    return finding(everything, all(better) or all(good.values()) or mostly, numbers, cause)


def _ratio(crack: Results) -> pd.DataFrame:
    return whole_grid(crack, "G1_error", CRACK).abs() / whole_grid(crack, "G2_error", CRACK).abs()


def _measures(results: Results) -> dict[str, pd.DataFrame]:
    """The grids that h̃ is judged by, relative errors by names that end in "error"."""
    plate = results.other("plate")
    names = ("frequency_error", "amplitude_error")
    found = {f"plate {name}": whole_grid(plate, name, PLATE) for name in names}
    for mode in ("mode1", "mode2"):
        crack = results.other(mode)
        found[f"{mode} G2_error"] = whole_grid(crack, "G2_error", CRACK)
        fields = norms(crack, DISPLACEMENTS + STRESSES)
        found |= {f"{mode} {field}": grid for field, grid in fields.items()}
    return found


@claim(
    "S2",
    "A better treatment of tensile instability than artificial stress is needed (suggested: "
    "corrections, stress points).",
    "sections 5.1, 5.5 and 6",
    reproduced="at h̃ = 1.5 artificial stress raises the plate's roughness below the axis to "
    f"{VISIBLE:g} or more at a resolution where it is less without it, and the mean frequency "
    "error is not smaller with it",
    partly="one of the two",
    otherwise="neither: artificial stress does no harm. Whether the suggested methods do better "
    "is not part of this verdict: only the thesis's method is computed here",
)
def treatment(results: Results) -> Finding:
    """The plate with artificial stress against the plate without."""
    plate = results.other("plate")
    base = {
        metric: whole_grid(plate, metric, PLATE).loc[1.5]
        for metric in ("frequency_error", "stress_roughness_bottom")
    }
    treated = {
        metric: pd.Series({n: plate.value(metric, {"h": 1.5, "n": n}, "artificial") for n in PLATE})
        for metric in base
    }
    rough, smooth = treated["stress_roughness_bottom"], base["stress_roughness_bottom"]
    disturbed = bool(((rough >= VISIBLE) & (smooth < VISIBLE)).any())
    no_gain = treated["frequency_error"].abs().mean() >= base["frequency_error"].abs().mean()
    numbers = "; ".join(
        f"n = {n}: ω error {signed(treated['frequency_error'][n])} instead of "
        f"{signed(base['frequency_error'][n])}, roughness {percent(rough[n])} instead of "
        f"{percent(smooth[n])}"
        for n in PLATE
    )
    numbers = because(f"h̃ = 1.5 with artificial stress: {numbers}", _cure(results))
    return finding(disturbed and no_gain, disturbed or no_gain, numbers)


def _cure(results: Results) -> str:
    """In words: what artificial stress does at (15, 1.3), at full load and at hardly any.

    Empty if the study `conjectures` lacks these points.
    """
    numbers = []
    for amplitude, words in (
        (FULL, "unstable without it"),
        (THOUSANDTH, "a thousandth of the amplitude"),
    ):
        treated, plain = (plate_test(results, 1.3, "cubic", stress, amplitude) for stress in (0.3, 0.0))
        if treated and plain:
            numbers.append(
                f"{words}: ω error {signed(treated[0])} instead of {signed(plain[0])}, roughness "
                f"{percent(treated[1])} instead of {percent(plain[1])}"
            )
    return f"at (15, 1.3), {'; '.join(numbers)}" if numbers else ""
