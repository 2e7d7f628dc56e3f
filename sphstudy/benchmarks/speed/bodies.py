"""Systems to be timed: a scene, its particles as they come, perturbed, or in random order too."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from sphstudy.catalogue import method_module, scene_module
from sphstudy.configuration.composition import Session
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.model.problem import Problem
from sphstudy.numerics.solvers import explicit
from sphstudy.numerics.solvers.potential_system import PotentialSystem
from sphstudy.numerics.solvers.system import System
from sphstudy.numerics.sph.kernel import KERNELS

PERTURBATION = 0.1
"""Largest distance of particles of a perturbed lattice from their sites along each axis, in spacings."""

LOAD_STEPS = 100_000
"""Steps in which driven particles would reach the full load: more than any measurement makes."""

LATTICE, PERTURBED, SHUFFLED = "lattice", "perturbed", "shuffled"


@dataclass(frozen=True)
class Case:
    """What is timed. group: part of the study; settings: overrides that make the configuration.

    arrangement: LATTICE, PERTURBED (row by row still) or SHUFFLED (perturbed, in random order). term and
    variant: which term of the method is varied, and how. absent: fields of the model that it never gets.
    cracked: with the scene's crack. bound: name of a bound (bounds.yaml) or "".
    """

    label: str
    group: str
    settings: tuple[str, ...]
    arrangement: str = LATTICE
    term: str = ""
    variant: str = ""
    absent: tuple[str, ...] = ()
    cracked: bool = True
    bound: str = ""


@dataclass(frozen=True)
class Made:
    """A system that stands at the beginning of its first stage.

    evaluations: of the right-hand side in a step. interacting: unordered pairs within the kernel's
    support at the start, seen past a crack or not.
    """

    config: RunConfig
    system: System
    particles: int
    evaluations: int
    interacting: int


def arranged(problem: Problem, arrangement: str, seed: int = 1) -> Problem:
    """The problem with its particles in this arrangement; a crack stays with its particles."""
    if arrangement == LATTICE:
        return problem
    random, body = np.random.default_rng(seed), problem.body
    count = body.x.size
    order = random.permutation(count) if arrangement == SHUFFLED else np.arange(count)
    place = np.argsort(order)
    off = PERTURBATION * random.uniform(-1.0, 1.0, (2, count))
    held = problem.constraints
    return replace(
        problem,
        body=replace(
            body,
            x=(body.x + off[0] * body.spacing_x)[order],
            y=(body.y + off[1] * body.spacing_y)[order],
            mass=body.mass[order],
            tags={name: mask[order] for name, mask in body.tags.items()},
        ),
        constraints=held._replace(x_index=place[held.x_index], y_index=place[held.y_index]),
        velocity_x=problem.velocity_x[order],
        velocity_y=problem.velocity_y[order],
        tracked=int(place[problem.tracked]),
        crack_first=place[problem.crack_first],
        crack_second=place[problem.crack_second],
    )


def made(hydra: Session, case: Case, threads: int = 1) -> Made:
    """The system of a case, whose sums over pairs are shared by threads.

    Raises ConfigurationError if settings are not valid, RuntimeError if the first stage cannot begin.
    """
    (point,), _ = hydra.points(list(case.settings), sweep=False)
    config = point.config
    scene, method = scene_module(config.scene.kind), method_module(config.method.kind)
    problem = arranged(scene.build(config), case.arrangement)
    dt, integrator = explicit.time_step(problem, config, method), explicit.integrator(config, method)
    system = method.system(problem, config, dt, integrator, threads)
    if case.absent:
        none = dict.fromkeys(case.absent)
        extra = (integrator,) if isinstance(system, PotentialSystem) else ()
        system = type(system)(
            problem, dt, lambda nodes: method.model(problem, config, nodes)._replace(**none), *extra
        )
    stage = problem.stages[0]
    stage = stage if case.cracked else replace(stage, crack_nodes=0)
    wrong = system.begin(stage, 1.0 / (LOAD_STEPS * dt) if stage.action == "load" else 0.0, None)
    if wrong:
        raise RuntimeError(f"{case.label}: {wrong}")
    count = problem.body.x.size
    evaluations = 2 if integrator == "heun" else 1
    return Made(config, system, count, evaluations, interacting_pairs(problem, config))


def interacting_pairs(problem: Problem, config: RunConfig) -> int:
    """Unordered pairs of particles that stand closer than the kernel's support."""
    support = KERNELS[config.method.kernel].support * config.h * problem.body.mean_spacing
    tree = cKDTree(np.column_stack((problem.body.x, problem.body.y)))
    # Pairs at exactly the support weigh nothing.
    return (int(tree.count_neighbors(tree, support * (1.0 - 1e-9))) - problem.body.x.size) // 2
