"""Vibrating plate by the thesis's formulation in PySPH's equations; run by the Python that has it.

python -P pysph.py settings.json: takes the body (npz) and the settings named there; leaves the series of
the tip, CPU seconds of the time loop, steps, time step and versions in `output` (JSON).
"""

import json
import sys
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
from pysph.base.kernels import CubicSpline
from pysph.base.nnps import LinkedListNNPS
from pysph.solver.solver import Solver
from pysph.sph.basic_equations import (
    ContinuityEquation,
    MonaghanArtificialViscosity,
    VelocityGradient2D,
    XSPHCorrection,
)
from pysph.sph.equation import Group
from pysph.sph.integrator import EPECIntegrator
from pysph.sph.integrator_step import SolidMechStep
from pysph.sph.solid_mech.basic import (
    HookesDeviatoricStressRate,
    IsothermalEOS,
    MomentumEquationWithStress,
    get_particle_array_elastic_dynamics,
)


class HeldStep(SolidMechStep):
    """Stress and density evolve, the particle stays: a wall without stress would be a hinge."""

    # fmt: off
    def stage1(
        self, d_idx, d_rho0, d_rho, d_arho, d_s00, d_s01, d_s11, d_s22, d_s000,
        d_s010, d_s110, d_s220, d_as00, d_as01, d_as11, d_as22, dt,
    ):
        d_rho[d_idx] = d_rho0[d_idx] + 0.5 * dt * d_arho[d_idx]
        d_s00[d_idx] = d_s000[d_idx] + 0.5 * dt * d_as00[d_idx]
        d_s01[d_idx] = d_s010[d_idx] + 0.5 * dt * d_as01[d_idx]
        d_s11[d_idx] = d_s110[d_idx] + 0.5 * dt * d_as11[d_idx]
        d_s22[d_idx] = d_s220[d_idx] + 0.5 * dt * d_as22[d_idx]

    def stage2(
        self, d_idx, d_rho0, d_rho, d_arho, d_s00, d_s01, d_s11, d_s22, d_s000,
        d_s010, d_s110, d_s220, d_as00, d_as01, d_as11, d_as22, dt,
    ):
        d_rho[d_idx] = d_rho0[d_idx] + dt * d_arho[d_idx]
        d_s00[d_idx] = d_s000[d_idx] + dt * d_as00[d_idx]
        d_s01[d_idx] = d_s010[d_idx] + dt * d_as01[d_idx]
        d_s11[d_idx] = d_s110[d_idx] + dt * d_as11[d_idx]
        d_s22[d_idx] = d_s220[d_idx] + dt * d_as22[d_idx]
    # fmt: on


def particles(name: str, body, chosen: np.ndarray, settings: dict):
    """The chosen particles of the body as an array of PySPH's."""
    size = np.ones(int(chosen.sum()))
    return get_particle_array_elastic_dynamics(
        name=name,
        x=body["x"][chosen],
        y=body["y"][chosen],
        v=body["velocity"][chosen],
        m=settings["rho"] * float(body["volume"]) * size,
        rho=settings["rho"] * size,
        h=settings["h"] * float(body["spacing"]) * size,
        # A negative kernel value switches artificial stress off: the thesis's plate has none.
        constants={
            "wdeltap": -1.0,
            "rho_ref": settings["rho"],
            "E": settings["E"],
            "nu": settings["nu"],
        },
    )


def equations(settings: dict) -> list[Group]:
    """Those of PySPH's scheme for elastic solids, with the wall as a solid whose stress evolves."""
    every = ["plate", "wall"]
    first, second = [], []
    for name in every:
        first += [IsothermalEOS(name, None), VelocityGradient2D(name, every)]
        second += [ContinuityEquation(name, every), HookesDeviatoricStressRate(name, None)]
    second += [
        MomentumEquationWithStress("plate", every),
        MonaghanArtificialViscosity(
            "plate", every, settings["viscosity_linear"], settings["viscosity_quadratic"]
        ),
        XSPHCorrection("plate", every, settings["xsph"]),
    ]
    return [Group(first), Group(second)]


def run(settings: dict) -> dict:
    """One run of the plate."""
    body = np.load(settings["body"])
    clamped, step = body["clamped"], settings["time_step"]
    plate = particles("plate", body, ~clamped, settings)
    wall = particles("wall", body, clamped, settings)
    tip = int(np.sum(~clamped[: int(body["tip"])]))
    start = float(plate.y[tip])
    steps = int(np.ceil(settings["duration"] / step))
    every = max(1, steps // settings["samples"])
    times, deflection = [0.0], [0.0]

    def sample(solver: Solver) -> None:
        # Called before the solver counts the step.
        if (solver.count + 1) % every == 0:
            times.append(solver.t + solver.dt)
            deflection.append(float(plate.y[tip]) - start)

    kernel = CubicSpline(dim=2)
    solver = Solver(
        kernel=kernel,
        dim=2,
        integrator=EPECIntegrator(plate=SolidMechStep(), wall=HeldStep()),
        dt=step,
        tf=steps * step,
        adaptive_timestep=False,
        pfreq=10**9,
    )
    solver.set_disable_output(True)
    solver.set_parallel_manager(None)
    search = LinkedListNNPS(dim=2, particles=[plate, wall], radius_scale=kernel.radius_scale)
    solver.setup([plate, wall], equations(settings), nnps=search, kernel=kernel)
    solver.add_post_step_callback(sample)
    began = time.process_time()
    try:
        solver.solve(show_progress=False)
    except RuntimeError:
        # The neighbour search gives up when particles fly apart.
        if np.hypot(plate.u, plate.v).max() < settings["speed_limit"]:
            raise
    seconds = time.process_time() - began
    largest = float(np.hypot(plate.u, plate.v).max())
    return {
        "time": times,
        "deflection": deflection,
        "largest_speed": largest if np.isfinite(largest) else None,
        "cpu_seconds": seconds,
        "steps": solver.count,
        "time_step": step,
        "particles": clamped.size,
        "versions": {name: version(name) for name in ("pysph", "compyle", "cython", "numpy")},
    }


if __name__ == "__main__":
    given = json.loads(Path(sys.argv[1]).read_text())
    Path(given["output"]).write_text(json.dumps(run(given)))
