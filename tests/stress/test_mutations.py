"""Errors put into a copy of the program each fall outside the stored references, on small cells."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

import sphstudy

pytestmark = pytest.mark.slow

ROOT = Path(sphstudy.__file__).parent.parent

PAIR_SUMS = "sphstudy/numerics/sph/pair_sums.py"
METHOD = "conf/method/thesis.yaml"
SCENE = "conf/scene/mode1.yaml"
MUTATIONS = {
    "kernel gradient turned round": (PAIR_SUMS, "factor = scale *", "factor = -scale *", "plate"),
    "viscosity of the printed sign": (PAIR_SUMS, "* specific - pi", "* specific + pi", "plate"),
    "XSPH dropped": (METHOD, "xsph: 0.5", "xsph: 0.0", "mode1"),
    "exclusive visibility": (METHOD, "visibility: inclusive", "visibility: exclusive", "mode1"),
    "one frame layer": (SCENE, "frame_layers: 2", "frame_layers: 1", "mode1"),
    "primed constants in the energy": (SCENE, "constants: unprimed", "constants: primed", "mode1"),
}


@pytest.fixture
def copied(tmp_path):
    """A copy of the program and its data, which does not know the checkout."""
    for part in ("sphstudy", "conf", "studies", "results/reference"):
        shutil.copytree(ROOT / part, tmp_path / part, ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def compared(copy, block):
    """The study `small`, reduced to one block, run by the copy: its exit status and output."""
    path = copy / "studies" / "small.yaml"
    study = yaml.safe_load(path.read_text())
    study["blocks"] = {block: study["blocks"][block]}
    path.write_text(yaml.safe_dump(study))
    result = subprocess.run(
        [sys.executable, "-m", "sphstudy", "study", "small"],
        cwd=copy,
        env={**os.environ, "PYTHONPATH": str(copy)},
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert "compared: " in result.stdout, result.stderr
    return result.returncode, result.stdout


@pytest.mark.parametrize("block", ["plate", "mode1"])
def test_the_unchanged_copy_is_within(copied, block):
    status, shown = compared(copied, block)
    assert status == 0, shown
    assert "outside" not in shown


@pytest.mark.parametrize("name", MUTATIONS)
def test_a_mutation_falls_outside(copied, name):
    file, before, after, block = MUTATIONS[name]
    path = copied / file
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after))
    status, shown = compared(copied, block)
    assert status == 1, shown
    assert "outside" in shown
