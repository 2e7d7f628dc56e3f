"""Square with an edge crack, its frame driven to the Williams field of mode I or II (thesis 3.3).

After the state with crack length a has settled, the crack is opened one particle spacing at a time,
the frame held, which gives the energies of the propagation estimate G1.
"""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from sphstudy.model.constraints import Constraints
from sphstudy.model.exact import williams
from sphstudy.model.lattice import lattice_sites, square
from sphstudy.model.problem import Body, Problem, Stage
from sphstudy.model.scenes.solid import SolidParameters
from sphstudy.parameters import count, described, number, parameters


@parameters
class Parameters(SolidParameters):
    """A square of `n` by `n` particles (even: the tip lies between columns)."""

    mode: Literal[1, 2] = described("1: opening, 2: sliding")
    L: float = number("side of the square", "m", gt=0)
    K: float = number("stress intensity factor of the prescribed field", "Pa m0.5", gt=0)
    plane: Literal["stress"] = described("plane stress: the exact field is written for it")
    frame_layers: int = count("layers of particles, from the edge inwards, that are driven", ge=1)
    extensions: int = count("how often the crack is opened by one spacing (2 for G1)", ge=0, le=2)
    energy_constants: Literal["unprimed", "primed"] = described(
        "strains of the energy (3.18) from E and ν, or from the thesis's E' and ν'",
    )


def check(config) -> Iterator[str]:
    """Complaints about the resolution."""
    scene = config.scene.name
    if config.n % 2:
        yield f"n={config.n}: must be even in {scene} (crack between rows, tip between columns)"
    least = 2 * (config.scene.frame_layers + config.scene.extensions + 2)
    if config.n < least:
        yield f"n={config.n}: must be at least {least} in {scene} (for frame, tip and extensions)"


def particles(config) -> int:
    """How many particles the scene has."""
    return config.n * config.n


def crack_body(config) -> Body:
    """The square; tags: "frame" (driven), "faces" (rows beside the crack), "ahead", "tip" disc."""
    scene, n = config.scene, config.n
    x, y, spacing = square(scene.L, n)
    edge = 0.5 * scene.L - scene.frame_layers * spacing
    beside = np.abs(y) < spacing
    tags = {
        "frame": np.maximum(np.abs(x), np.abs(y)) > edge,
        "faces": beside & (x < 0.0),
        "ahead": beside & (x > 0.0),
        "tip": np.hypot(x, y) < 3.0 * config.h * spacing,
    }
    return Body.of_squares(x, y, spacing, scene.material, tags=tags, sites=lattice_sites(n, n))


def build(config) -> Problem:
    """Problem of the cracked square: driven frame, floating crack, load, settle, extend."""
    scene, n = config.scene, config.n
    body, primed = crack_body(config), scene.energy_constants == "primed"
    material = body.material
    u_x, u_y = williams.displacement(scene.mode, body.x, body.y, scene.K, scene.E, scene.nu)
    frame = np.flatnonzero(body.tags["frame"])
    # One node per column: half-way between the particles of the two rows beside y = 0.
    below = np.arange(n, dtype=np.int64) + (n // 2 - 1) * n
    nodes = n // 2
    extensions = tuple(
        Stage(f"extend{k}", "settle", crack_nodes=nodes + k, extension=True)
        for k in range(1, scene.extensions + 1)
    )
    return Problem(
        body=body,
        constraints=Constraints(frame, u_x[frame], frame, u_y[frame]),
        stages=(
            Stage("load", "load", crack_nodes=nodes),
            Stage("settle", "settle", crack_nodes=nodes),
            *extensions,
        ),
        step_spacing=body.spacing_x,
        energy_compliance=material.primed if primed else material.compliance,
        velocity_x=np.zeros(body.x.size),
        velocity_y=np.zeros(body.x.size),
        tracked=int(np.flatnonzero(body.tags["faces"] & (body.y > 0.0))[0]),
        crack_first=below,
        crack_second=below + n,
        mirrors=("y",) if scene.mode == 1 else (),
    )
