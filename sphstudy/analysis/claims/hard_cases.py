"""What theory says of hard cases, each by a run and its counter-run (study `stability`)."""

from sphstudy.analysis.claims.claim import Finding, claim
from sphstudy.analysis.claims.reading import finding, signed
from sphstudy.analysis.claims.tensile_instability import unstable_side
from sphstudy.analysis.results import Missing, Results
from sphstudy.analysis.stability.cases import judged
from sphstudy.analysis.stability.judge import DONE
from sphstudy.text import number

HELD = 0.5
"""Share of the exact stress: below, a bar that is held has lost it; a sound one has nearly all."""

CLUMPED = 0.9
"""Smallest distance between neighbours over the exact one: below, particles have clumped."""

LOST = 0.5
"""Relative change of angular momentum: beyond, a body no longer turns as it did."""

SOUND = 1e-12
"""The same, as rounding leaves it."""

NO_HOURGLASS = "hourglass 0"
"""In the name of a variant of the total Lagrangian method that lacks its hourglass energy."""


def _values(results: Results, block: str, metric: str, **settings: float | str) -> dict[float, float]:
    """A metric of a block's points with these settings (dots in keys as "__"), by h."""
    wanted = {key.replace("__", "."): value for key, value in settings.items()}
    if results.table.empty:
        raise Missing(f"{results.name}: no points")
    rows = results.select(wanted, block)
    found = {float(row["h"]): float(row[metric]) for _, row in rows.iterrows() if row["status"] == "done"}
    if not found or len(found) < len(rows):
        raise Missing(f"{results.name}: no {metric} of all points in block {block}")
    return found


def _by_h(values: dict[float, float], words=number) -> str:
    """Values with their h̃."""
    return ", ".join(f"{words(value)} (h̃ = {h:g})" for h, value in values.items())


def _size(value: float) -> str:
    return number(value, 2)


@claim(
    "H1",
    "The total Lagrangian method keeps every scene within its bounds.",
    "bounds in conf/scene: exact answers, invariants, published values",
    reproduced="every run of it with its hourglass energy is done",
    partly="all are finite, some degraded",
    otherwise="one diverges or fails",
)
def total_lagrangian_is_sound(results: Results) -> Finding:
    """Judgements of all its runs; beside them those of the thesis's method."""
    cases = [
        c for c in judged(results) if c.judgement.outcome not in ("missing", "running", "interrupted")
    ]
    own = [c for c in cases if c.variant.startswith("tl") and NO_HOURGLASS not in c.variant]
    if not own:
        raise Missing(f"{results.name}: no run of the total Lagrangian method")
    bad = [c for c in own if c.judgement.outcome != DONE]
    finite = all(c.judgement.outcome in (DONE, "degraded") for c in own)
    others = [c for c in cases if c.variant.startswith("thesis")]
    sound = sum(c.judgement.outcome == DONE for c in others)
    numbers = (
        f"{len(own) - len(bad)} of {len(own)} runs are done; of the thesis's {sound} of {len(others)}"
    )
    cause = "; ".join(
        f"{c.label}, h̃ = {c.h:g}: "
        + ", ".join(f"{b.bound.quantity} {_size(b.value)}" for b in c.judgement.breaches[:2])
        for c in bad
    )
    return finding(not bad, finite, numbers, cause)


@claim(
    "H2",
    "A bar held at 1 % strain loses its stress under the thesis's method.",
    "found before this program; its cause is the spurious mode that centred sums do not see",
    reproduced=f"less than {signed(HELD)} is left at h̃ = 1.3 and 1.5, where total Lagrangian keeps more",
    partly="at one of the two",
    otherwise="at neither",
)
def held_bar(results: Results) -> Finding:
    """Stress away from ends and faces after 12 s over the exact one."""
    found = _values(results, "tension", "stress_share", scene__strain=0.01)
    other = _values(results, "tension_tl", "stress_share", scene__strain=0.01)
    lost = [found[h] < HELD < other[h] for h in (1.3, 1.5)]
    numbers = f"stress left: {_by_h(found, signed)}; total Lagrangian {_by_h(other, signed)}"
    return finding(all(lost), any(lost), numbers)


@claim(
    "H3",
    "A stress rate without spin terms cannot rotate: the thesis's method loses a spinning square; "
    "Jaumann's rate saves it.",
    "the stress rate (2.4) has no spin terms; that of Gray, Monaghan & Swift 2001 has",
    reproduced="angular momentum is lost without it at every h̃, kept with it, and by total Lagrangian",
    partly="it is lost without, kept by total Lagrangian, but lost with Jaumann's rate too",
    otherwise="it is not lost without it",
)
def rotation(results: Results) -> Finding:
    """Largest relative change of angular momentum in ten turns."""
    plain, jaumann, total = (
        _values(results, block, "angular_momentum_drift") for block in ("spin", "spin_jaumann", "spin_tl")
    )
    lost = all(v > LOST for v in plain.values()) and all(v < SOUND for v in total.values())
    saved = all(v < LOST for v in jaumann.values())
    numbers = (
        f"drift without spin terms {_by_h(plain, _size)}; with Jaumann's rate {_by_h(jaumann, _size)}; "
        f"total Lagrangian {_by_h(total, _size)}"
    )
    cause = (
        "probably uncorrected gradients, to which a rigid rotation looks like strain at the edges, where "
        "stress begins with or without spin terms"
    )
    return finding(lost and saved, lost, numbers, cause)


@claim(
    "H4",
    "Tension is unstable where W'' at the nearest neighbour is positive (h̃ < 1.5), compression where it "
    "is negative (h̃ > 1.5).",
    "Swegle, Hicks & Attaway 1995",
    reproduced="a bar at +5 % clumps at h̃ = 1.3 and not at 1.7, one at -5 % at 1.7 and not at 1.3",
    partly="both unstable sides clump, one of the stable ones too",
    otherwise="an unstable side does not clump",
)
def sign_of_curvature(results: Results) -> Finding:
    """Smallest distance between neighbours over the exact one, held at +5 and -5 %."""
    stretched = _values(results, "tension", "spacing_smallest", scene__strain=0.05)
    pressed = _values(results, "compression", "spacing_smallest")
    unstable = stretched[1.3] < CLUMPED and pressed[1.7] < CLUMPED
    stable = stretched[1.7] >= CLUMPED and pressed[1.3] >= CLUMPED
    numbers = f"stretched {_by_h(stretched, _size)}; compressed {_by_h(pressed, _size)}"
    cause = (
        f"{unstable_side(1.3)}; {unstable_side(1.7)}; but the checkerboard that "
        "centred sums do not see knows no sign"
    )
    return finding(unstable and stable, unstable, numbers, cause)


@claim(
    "H5",
    "Heun's method without viscosity is unstable: the thesis's vibrating plate blows up without it.",
    "its amplification factor exceeds one on the whole imaginary axis",
    reproduced="it diverges at every h̃ without viscosity, at none with it",
    partly="at some without, at none with it",
    otherwise="at none without, or at one with it",
)
def heun_lives_by_viscosity(results: Results) -> Finding:
    """Outcomes of one period of the plate."""
    outcomes = {
        block: {float(row["h"]): str(row["status"]) for _, row in results.select({}, block).iterrows()}
        for block in ("no_viscosity", "viscosity")
    }
    if not all(outcomes.values()) or any(
        status == "missing" for found in outcomes.values() for status in found.values()
    ):
        raise Missing(
            f"{results.name}: not all plates of the blocks no_viscosity and viscosity are stored"
        )
    gone = [status == "diverged" for status in outcomes["no_viscosity"].values()]
    fine = all(status == "done" for status in outcomes["viscosity"].values())
    numbers = "; ".join(f"{block}: {_by_h(found, str)}" for block, found in outcomes.items())  # type: ignore[arg-type]
    return finding(all(gone) and fine, any(gone) and fine, numbers)


@claim(
    "H6",
    "Colliding rings: the thesis's method breaks them; with Jaumann's rate and artificial stress it "
    "holds at 0.06 c0 and breaks them at 0.12 c0; the total Lagrangian method breaks nothing.",
    "Gray, Monaghan & Swift 2001, and found before this program",
    reproduced="broken bonds at both speeds without repairs, at 0.12 c0 with them, none otherwise",
    partly="the total Lagrangian method breaks none, and the thesis's method does at both speeds",
    otherwise="not even that",
)
def rings(results: Results) -> Finding:
    """Bonds between lattice neighbours that are twice as long at the end."""
    broken = {
        (block, speed): _values(results, block, "broken_bonds", scene__speed=speed, scene__nu=0.3975)[1.5]
        for block in ("rings", "rings_repaired", "rings_tl")
        for speed in (0.06, 0.12)
    }
    thesis = broken["rings", 0.06] > 0 and broken["rings", 0.12] > 0
    total = broken["rings_tl", 0.06] == 0 and broken["rings_tl", 0.12] == 0
    repaired = broken["rings_repaired", 0.06] == 0 and broken["rings_repaired", 0.12] > 0
    numbers = "; ".join(
        f"{name} {broken[block, 0.06]:.0f} and {broken[block, 0.12]:.0f}"
        for block, name in (
            ("rings", "thesis"),
            ("rings_repaired", "repaired"),
            ("rings_tl", "total Lagrangian"),
        )
    )
    core = thesis and total
    cause = "artificial stress delays tearing, it does not prevent it" if core else ""
    return finding(core and repaired, core, f"bonds broken at 0.06 and 0.12 c0: {numbers}", cause)
