"""Claims about the bent plate (thesis 4.2, 5.2)."""

from sphstudy.analysis.claims.claim import Finding, claim
from sphstudy.analysis.claims.reading import finding, interval
from sphstudy.analysis.claims.tensile_instability import unstable_side
from sphstudy.analysis.results import Results
from sphstudy.text import number, percent

CASE = {"h": 1.7, "n": 21}
"""The case that the thesis shows."""

AGREES = 0.01
"""Error of the centreline over the deflection that figure 4.6 would just show: about the width of a
line.
"""

ORDER_OF_A_TENTH = (0.1 / 10**0.5, 0.1 * 10**0.5)
"""End-angle errors (degrees) closer to 0.1 than to 0.01 or 1 on a logarithmic scale."""

SEEN_AT_WALL, SEEN_AT_END = 2e-5, 8e-5
"""Jags (m) that figures 4.7a and 4.7b would just show: a hundredth of their axes, 2 mm and 8 mm high."""

PRONOUNCED = 10.0
"""Smallest ratio of a boundary effect to the jags in the middle of the span."""

REGULAR, IRREGULAR = 0.02, 0.05
"""Spread of nearest-neighbour distances (standard deviation over mean) of regular and irregular
particles.
"""


@claim(
    "B1",
    "(n, h̃) = (21, 1.7) at 11 s: the centreline agrees very well with the beam; the error of the "
    "end angle is of order 0.1 (degrees: 0.1 rad would exceed the angle itself).",
    "section 4.2, figure 4.6",
    reproduced=f"the largest error of the centreline is at most {percent(AGREES)} of the deflection, "
    f"and that of the end angle lies in {interval(ORDER_OF_A_TENTH)} degrees",
    partly="the centreline does, or the end angle is not further off",
    otherwise="neither",
)
def agreement(results: Results) -> Finding:
    """Errors of centreline and end angle."""
    error = results.value("centreline_error_max", CASE, "grid")
    scene = results.config(CASE, "grid").scene
    error /= abs(scene.deflection * scene.L)
    angle = abs(results.value("end_angle_error", CASE, "grid"))
    least, most = ORDER_OF_A_TENTH
    numbers = (
        f"centreline within {percent(error)} of the deflection, end angle {number(angle, 2)} degrees off "
        f"({number(abs(results.value('end_angle_error_2d', CASE, 'grid')), 2)} against 2-D elasticity)"
    )
    everything = error <= AGREES and least <= angle <= most
    cause = unstable_side(CASE["h"])
    return finding(everything, error <= AGREES or angle <= most, numbers, cause)


@claim(
    "B2",
    "(n, h̃) = (21, 1.7) at 11 s: boundary effects show at the wall and at the end.",
    "section 4.2, figure 4.7",
    reproduced=f"the largest jag of the centreline is at least {1e3 * SEEN_AT_WALL:g} mm for "
    f"x0 < 0.15 m and {1e3 * SEEN_AT_END:g} mm for x0 > 0.9 m, and {PRONOUNCED:g} times that "
    "of the span between",
    partly="that holds on one side",
    otherwise="on neither",
)
def boundary_effects(results: Results) -> Finding:
    """Jags of the centreline near wall and end against those of the middle."""
    wall, middle, end = (
        results.value(f"centreline_roughness_{part}", CASE, "grid") for part in ("wall", "middle", "end")
    )
    seen = [
        jag >= least and jag >= PRONOUNCED * middle
        for jag, least in ((wall, SEEN_AT_WALL), (end, SEEN_AT_END))
    ]
    millimetres = [number(1e3 * jag, 2) for jag in (wall, middle, end)]
    numbers = "largest jag {} mm at the wall, {} mm in the middle, {} mm at the end".format(*millimetres)
    return finding(all(seen), any(seen), numbers)


@claim(
    "B3",
    "Positions are regular at 11 s; after 150 s they are irregular for 0 < x < 0.3 m and clumped "
    "in lines below the axis there.",
    "section 4.2, figures 4.8 and 4.9 (for n = 21)",
    reproduced=f"the spread of nearest-neighbour distances is at most {percent(REGULAR)} everywhere "
    f"at 11 s; at the end it is at least {percent(IRREGULAR)} below the axis near the wall, and "
    "larger there than above and beyond",
    partly="it is regular at 11 s and has at least doubled below the axis near the wall, where it "
    "is largest",
    otherwise="not even that",
)
def clumping(results: Results) -> Finding:
    """Spread of nearest-neighbour distances in three parts of the plate, early and late."""
    parts = ("bottom", "top", "rest")
    early = {p: results.value(f"spacing_spread_{p}_11s", block="grid") for p in parts}
    late = {p: results.value(f"spacing_spread_{p}", block="grid") for p in parts}
    closest = results.value("spacing_smallest_bottom", block="grid")
    regular = max(early.values()) <= REGULAR
    worst = late["bottom"] > max(late["top"], late["rest"])
    config = results.config(block="grid")
    numbers = (
        f"n = {config.n}: spread at 11 s "
        + ", ".join(f"{percent(early[p])} {p}" for p in parts)
        + f"; at {config.scene.end_time:g} s "
        + ", ".join(f"{percent(late[p])} {p}" for p in parts)
        + f"; closest below {number(closest, 3)} Δ; {unstable_side(config.h)}"
    )
    cause = (
        f"below the axis the spread is {number(late['bottom'] / early['bottom'], 2)} times that at 11 s"
    )
    if config.n != CASE["n"]:
        cause += f"; the thesis shows n = {CASE['n']}, computed is n = {config.n}"
    grown = late["bottom"] >= 2.0 * early["bottom"]
    everything = regular and worst and late["bottom"] >= IRREGULAR
    return finding(everything, regular and worst and grown, numbers, cause)
