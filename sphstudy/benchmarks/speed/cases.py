"""Which systems are timed: the forms that pairs come in, sizes, and each term of a method on its own."""

from collections.abc import Iterator

from sphstudy.benchmarks.speed.bodies import PERTURBED, SHUFFLED, Case

_THESIS, _TL = ("method=thesis", "h=1.5"), ("method=tl", "h=1.3")
_SMALL_STEP = ("solve.courant=0.2",)
"""Stable also where particles stand closer than on the lattice, or viscosity stiffens the system."""

ROWS = (9, 29, 91, 289)
"""Rows of the plates whose size grows: 12 n² particles, about 1e3, 1e4, 1e5 and 1e6."""

MOST_SHUFFLED = 91
"""Rows up to which particles in random order are timed: beyond, every pair waits for memory anyway."""

THESIS_TERMS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "XSPH": (("method.xsph=0",), ("xsph",)),
    "viscosity": (("method.viscosity_linear=0", "method.viscosity_quadratic=0"), ("viscosity",)),
    "artificial stress": (("method.artificial_stress=0",), ("artificial",)),
    "damping": (("method.damping=0",), ("damping",)),
    "smearing": (("method.smoothing=0",), ("smoothing",)),
    "crack": ((), ("crack",)),
}
"""Terms of the thesis's method: settings that switch one off, and its field of the model."""

TL_TERMS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "hourglass": (("method.hourglass=0",), ("hourglass",)),
    "viscosity": (("method.viscosity_linear=0",), ("viscosity",)),
    "damping": (("method.damping=0",), ("damping",)),
}
"""Terms of the total Lagrangian method."""


def forms() -> list[Case]:
    """The methods on the bodies that the thesis has, and on particles that stand on no lattice."""
    plate, crack = ("scene=plate", "n=21"), ("scene=mode1", "n=60")
    return [
        Case("thesis, plate", "forms", (*_THESIS, *plate), bound="thesis plate"),
        Case("thesis, crack", "forms", (*_THESIS, *crack), bound="thesis crack"),
        _general("thesis, plate", "forms", (*_THESIS, *plate), PERTURBED, "thesis general"),
        _general("thesis, plate", "forms", (*_THESIS, *plate), SHUFFLED, "thesis general"),
        Case("tl, plate", "forms", (*_TL, *plate), bound="tl lattice"),
        Case("tl, crack", "forms", (*_TL, *crack), bound="tl lattice"),
        _general("tl, plate", "forms", (*_TL, *plate), PERTURBED, "tl general"),
        _general("tl, plate", "forms", (*_TL, *plate), SHUFFLED),
    ]


def growth(rows: tuple[int, ...] = ROWS) -> list[list[Case]]:
    """Plates of these rows, a list for each form: only one form's systems stand in memory at a time."""
    found = []
    for name, settings, bound in (("thesis", _THESIS, ""), ("tl", _TL, "tl general")):
        plates = [(n, (*settings, "scene=plate", f"n={n}")) for n in rows]
        found.append([Case(f"{name}, n={n}", "growth", overrides) for n, overrides in plates])
        found.append(
            [_general(f"{name}, n={n}", "growth", plate, PERTURBED, bound) for n, plate in plates]
        )
        found.append(
            [_general(f"{name}, n={n}", "growth", p, SHUFFLED) for n, p in plates if n <= MOST_SHUFFLED]
        )
    return found


def terms(n: int) -> list[Case]:
    """For both methods, on the cracked square with `n` columns: all terms, each one off, and none."""
    square = ("scene=mode1", f"n={n}")
    thesis = (*_THESIS, *square)
    tl = (*_TL, *square, *_SMALL_STEP, "method.viscosity_linear=1")
    return [*_varied("thesis", thesis, THESIS_TERMS), *_varied("tl", tl, TL_TERMS)]


def _general(
    label: str, group: str, settings: tuple[str, ...], arrangement: str, bound: str = ""
) -> Case:
    return Case(
        f"{label}, {arrangement}", group, (*settings, *_SMALL_STEP), arrangement=arrangement, bound=bound
    )


def _varied(
    name: str, settings: tuple[str, ...], varied: dict[str, tuple[tuple[str, ...], tuple[str, ...]]]
) -> Iterator[Case]:
    yield Case(f"{name}, all terms", "terms", settings, variant="all")
    for term, (off, fields) in varied.items():
        changed = _replaced(settings, off)
        yield Case(
            f"{name}, {term} off", "terms", changed, term=term, variant="off", cracked=term != "crack"
        )
        yield Case(f"{name}, never {term}", "terms", settings, term=term, variant="never", absent=fields)
    every = tuple(override for off, _ in varied.values() for override in off)
    bare = _replaced(settings, every)
    yield Case(f"{name}, no terms", "terms", bare, variant="none", cracked="crack" not in varied)


def _replaced(settings: tuple[str, ...], changes: tuple[str, ...]) -> tuple[str, ...]:
    """The overrides with those of the same keys replaced."""
    keys = {change.partition("=")[0] for change in changes}
    return (*(s for s in settings if s.partition("=")[0] not in keys), *changes)
