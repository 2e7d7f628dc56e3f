"""Limits that a run was asked to stop at, looked at whenever it is sampled."""

import numpy as np

from sphstudy.numerics.solvers.solution import HISTORY


def breached(history: list[tuple[float, ...]], spacing: float, solve) -> str:
    """Which limit of the solver's settings the last sample breaks, in words; "" if none.

    `history`: rows as in solution.HISTORY; spacing (m).
    """
    now = dict(zip(HISTORY, history[-1], strict=True))
    if solve.stop_energy_gain is not None:
        gain = energy_gain(history)
        if gain > solve.stop_energy_gain:
            return f"energy gained, {gain:.3g} of what was put in (limit {solve.stop_energy_gain:g})"
    closest = now["smallest_spacing"] / spacing
    if solve.stop_spacing is not None and closest < solve.stop_spacing:
        return f"particles {closest:.3g} spacings apart (limit {solve.stop_spacing:g})"
    if solve.stop_hourglass is not None and now["hourglass_share"] > solve.stop_hourglass:
        return f"a checkerboard share of {now['hourglass_share']:.3g} (limit {solve.stop_hourglass:g})"
    if solve.stop_mirror is not None and now["mirror_defect"] > solve.stop_mirror:
        return f"a mirror defect of {now['mirror_defect']:.3g} spacings (limit {solve.stop_mirror:g})"
    return ""


def energy_gain(history: list[tuple[float, ...]]) -> float:
    """Energy found less energy put in, over the most of either that there was."""
    columns = ("time", "kinetic_energy", "strain_energy", "constraint_power")
    table = np.array(history)
    found, put_in = energies(*(table[:, HISTORY.index(name)] for name in columns))
    scale = max(np.abs(found).max(), np.abs(put_in).max())
    return float(found[-1] - put_in[-1]) / scale if scale > 0.0 else 0.0


def energies(
    time: np.ndarray, kinetic: np.ndarray, strain: np.ndarray, power: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Energy found and energy put in at each sample (J/m); initial energy counts as put in.

    All [S]; time (s), energies (J/m), power of the constraints (W/m).
    """
    found = kinetic + strain
    work = np.concatenate(([0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(time))))
    return found, found[0] + work
