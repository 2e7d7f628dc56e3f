"""Lowest frequency of the plate by finite elements of scikit-fem; run by the Python that has it.

python -P skfem.py settings.json: as the other drivers, with a frequency (rad/s) in place of a series. The
body is the one that particles stand for, with as many nodes across as it has rows.
"""

import json
import sys
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
import scipy.sparse.linalg
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity


@skfem.BilinearForm
def product(u, v, _):
    """Integrand of the mass matrix over ρ."""
    return u[0] * v[0] + u[1] * v[1]


def run(settings: dict) -> dict:
    """The lowest mode, from the mesh to the frequency."""
    began = time.process_time()
    across = settings["elements"]
    columns = settings["slenderness"] * across
    mesh = skfem.MeshQuad.init_tensor(
        np.linspace(0.0, settings["L"], columns + 1),
        settings["L"] / settings["slenderness"] * np.linspace(-0.5, 0.5, across + 1),
    )
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()))
    stiffness = linear_elasticity(*lame_parameters(settings["E"], settings["nu"])).assemble(basis)
    mass = settings["rho"] * product.assemble(basis)
    free = basis.complement_dofs(basis.get_dofs(lambda x: np.isclose(x[0], 0.0)))
    squares = scipy.sparse.linalg.eigsh(
        stiffness[free][:, free].tocsc(),
        k=1,
        M=mass[free][:, free].tocsc(),
        sigma=0.0,
        v0=np.ones(free.size),
        return_eigenvectors=False,
    )
    return {
        "frequency": float(np.sqrt(squares[0])),
        "cpu_seconds": time.process_time() - began,
        "particles": int(basis.N) // 2,
        "versions": {name: version(name) for name in ("scikit-fem", "scipy", "numpy")},
    }


if __name__ == "__main__":
    given = json.loads(Path(sys.argv[1]).read_text())
    Path(given["output"]).write_text(json.dumps(run(given)))
