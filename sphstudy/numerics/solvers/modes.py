"""Free vibrations: lowest frequencies and shapes about the reference configuration."""

from collections.abc import Callable, Iterator

import numpy as np
import scipy.sparse.linalg

from sphstudy.model.problem import Problem
from sphstudy.numerics.solvers import timeless
from sphstudy.numerics.solvers.checkpoint import Keeper
from sphstudy.numerics.solvers.factorisation import Factorisation, NotSolvable
from sphstudy.numerics.solvers.newton import freedoms, freedoms_along_body
from sphstudy.numerics.solvers.solution import Solution, Variable
from sphstudy.numerics.sph import stiffness
from sphstudy.numerics.sph.total_lagrangian import Model
from sphstudy.parameters import count, described, parameters

SECONDS_PER_COST = 2e-6
"""CPU time per particle^1.5, on one Zen 4 core, where no run tells."""

THREADS = False
"""A run takes one thread: on two, BLAS adds in another order."""

SHIFT = 0.3
"""The spectrum is searched from -(SHIFT · c d/l²)² upwards, c the speed of shear waves, l and d the
body's longer and shorter extent: the lowest bending frequency of a slender body to within a small factor,
so below every mode and close to the lowest.
"""


@parameters
class Parameters:
    """How many modes."""

    name: str = described("name of the solver")
    count: int = count("modes found, the lowest ones", ge=1, le=1000)


def check(problem: Problem, config, method) -> Iterator[str]:
    """Complaints: a problem that is loaded, too many modes."""
    for stage in problem.stages:
        if stage.action != "run":
            yield (
                f"solve=modes: scene {config.scene.name} is loaded (stage {stage.name}), it does not "
                "vibrate; take equilibrium or explicit"
            )
            return
    held = problem.constraints.x_index.size + problem.constraints.y_index.size
    most = 2 * problem.body.x.size - held - 2
    if config.solve.count > most:
        yield f"solve.count={config.solve.count}: {config.label} has {most} that can be found"
    yield from timeless.check(config)


def predicted_steps(problem: Problem, config, method) -> int:
    """One factorisation."""
    return 1


def cost(particles: int, neighbours: float, steps: float) -> float:
    """What a run's CPU time goes with: a factorisation of the matrix of a plane body."""
    return steps * particles**1.5


def run(
    problem: Problem,
    config,
    method,
    on_progress: Callable[[int, int], None],
    keeper: Keeper | None = None,
    threads: int = 1,
) -> Solution:
    """Lowest modes of the problem in its first stage, by shift-invert Lanczos (ARPACK).

    A body that is not stable at rest, with a frequency that is not real, makes the run "diverged".
    """
    stage = problem.stages[0]
    model = method.model(problem, config, stage.crack_nodes)
    solution = Solution(pairs=model.bonds.total, steps=1, stage_steps={stage.name: 1})
    try:
        squares, shapes, variables = _lowest(model, config.solve.count)
    except (NotSolvable, scipy.sparse.linalg.ArpackNoConvergence) as wrong:
        solution.outcome, solution.message = "diverged", f"no modes: {wrong}"
        return solution
    solution.variables = variables | _participation(model, problem, squares, shapes)
    on_progress(1, 1)
    return solution


def _lowest(model: Model, wanted: int) -> tuple[np.ndarray, np.ndarray, dict[str, Variable]]:
    """ω² [K] (1/s²), shapes [K, 2N] with φᵀMφ = 1 kg/m, and variables that tell how good they are."""
    particles, free = model.x.size, freedoms(model)[1]
    unit = np.repeat(np.array([1.0, 0.0, 0.0, 1.0])[:, None], particles, axis=1)
    stiff = stiffness.tangent(model, stiffness.operators(model), unit)[free][:, free]
    mass = np.tile(model.mass, 2)[free]
    matrix = scipy.sparse.diags_array(mass).tocsc()
    shift = _shift(model)
    # Below all modes, so that zero-energy ones are found like any other.
    factors = Factorisation(stiff + shift * matrix, freedoms_along_body(model, free))
    inverse = scipy.sparse.linalg.LinearOperator(stiff.shape, factors.solve, dtype=float)
    squares, vectors = scipy.sparse.linalg.eigsh(
        stiff, k=wanted, M=matrix, sigma=-shift, OPinv=inverse, v0=np.ones(free.size)
    )
    order = np.argsort(squares)
    squares, vectors = squares[order], vectors[:, order]
    if squares[0] < -1e-6 * shift:
        raise NotSolvable(f"the body is not stable at rest (ω² = {squares[0]:.3g} 1/s²)")
    left = stiff @ vectors - mass[:, None] * vectors * squares
    size = np.linalg.norm(mass[:, None] * vectors, axis=0) * (np.abs(squares) + shift)
    product = vectors.T @ (mass[:, None] * vectors) - np.eye(wanted)
    shapes = np.zeros((wanted, 2 * particles))
    shapes[:, free] = vectors.T
    planar = shapes.reshape(wanted, 2, particles)
    omega = np.sqrt(np.maximum(squares, 0.0))
    variables = {
        "mode_frequency": Variable(("mode",), omega, "rad s-1", "angular frequency of the mode"),
        "mode_residual": Variable(
            ("mode",), np.linalg.norm(left, axis=0) / size, "1", "|Kφ - ω²Mφ| over (ω² + shift) |Mφ|"
        ),
        "mode_shape_x": Variable(("mode", "particle"), planar[:, 0], "1", "shape, x; φᵀMφ = 1 kg/m"),
        "mode_shape_y": Variable(("mode", "particle"), planar[:, 1], "1", "shape, y; φᵀMφ = 1 kg/m"),
        "mode_orthogonality": Variable(
            (), float(np.abs(product).max()), "1", "largest entry of ΦᵀMΦ - I"
        ),
        "factor_entries": Variable((), float(factors.entries), "1", "entries of the factors"),
    }
    return squares, shapes, variables


def _shift(model: Model) -> float:
    """-σ [1/s²], small beside the lowest frequencies of a slender body, large beside rounding."""
    extent = max(np.ptp(model.x), np.ptp(model.y))
    thickness = min(np.ptp(model.x), np.ptp(model.y))
    speed = np.sqrt(model.law.shear * model.volume[0] / model.mass[0])
    return float((SHIFT * speed * thickness / extent**2) ** 2)


def _participation(
    model: Model, problem: Problem, squares: np.ndarray, shapes: np.ndarray
) -> dict[str, Variable]:
    """How much of the initial kinetic energy each mode carries."""
    velocity = np.concatenate((problem.velocity_x, problem.velocity_y))
    momentum = np.tile(model.mass, 2) * velocity
    energy = float(momentum @ velocity)
    shares = (shapes @ momentum) ** 2 / energy if energy else np.zeros(squares.size)
    return {
        "mode_participation": Variable(
            ("mode",), shares, "1", "share of the initial kinetic energy in the mode"
        ),
    }
