"""The plate that every code is given: the same particles and first push; what it is compared with."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from sphstudy.configuration.composition import session
from sphstudy.configuration.run_settings import RunConfig
from sphstudy.errors import ConfigurationError
from sphstudy.model.exact import beam
from sphstudy.model.exact.elasticity2d import Reference, plate_frequencies
from sphstudy.model.problem import Problem
from sphstudy.model.scenes import plate as scene
from sphstudy.numerics.methods.updated_lagrangian import wave_speed

SHORT = 400
"""Steps of a run that tells whether a time step is stable."""

GROWTH = 10.0
"""Largest speed at the end of a run over the tip's first speed, above which the run has blown up."""


@dataclass(frozen=True)
class Plate:
    """The plate with n rows. unit: Δy/c0 (s), so that Δt = C unit (2.27); duration: one period (s)."""

    config: RunConfig
    unit: float
    duration: float
    beam_frequency: float
    speed_limit: float
    exact: Reference

    def body(self, columns: int, folder: Path) -> Path:
        """File (npz) in the folder with the plate's particles, given the number of clamped columns."""
        path = folder / f"plate-n{self.config.n}-clamped{columns}.npz"
        path.parent.mkdir(parents=True, exist_ok=True)
        problem = scene.build(_config(self.config.n, columns))
        body = problem.body
        np.savez(
            path,
            x=body.x,
            y=body.y,
            velocity=problem.velocity_y,
            clamped=body.tags["clamped"],
            volume=body.spacing_x * body.spacing_y,
            spacing=body.mean_spacing,
            tip=problem.tracked,
        )
        return path.absolute()

    @property
    def material(self) -> dict[str, Any]:
        """The material and the shape, for drivers."""
        own = self.config.scene
        return {name: getattr(own, name) for name in ("E", "nu", "rho", "L", "slenderness")}


def plate(n: int) -> Plate:
    """The plate with n rows. Raises ConfigurationError if the scene does not take n."""
    config = _config(n, 1)
    own, problem = config.scene, scene.build(config)
    exact, _ = plate_frequencies(own.represented_length(n), own.height, own.material)
    return Plate(
        config,
        problem.step_spacing / wave_speed(config, problem),
        float(problem.stages[0].duration or 0.0),
        beam.fundamental_frequency(own.E, own.rho, own.L, own.height),
        GROWTH * _fastest(problem),
        exact,
    )


def _fastest(problem: Problem) -> float:
    return float(np.abs(problem.velocity_y).max())


@lru_cache
def _config(n: int, columns: int) -> RunConfig:
    with session() as hydra:
        overrides = ["scene=plate", f"n={n}", f"scene.clamped_columns={columns}"]
        points, _ = hydra.points(overrides, sweep=False)
    if not points:
        raise ConfigurationError([f"n={n}: no plate"])
    return points[0].config
