"""Settings of the cluster launcher: answered in a line each, before anything runs."""

import sys
from types import SimpleNamespace

import pytest
from omegaconf import OmegaConf

from sphstudy import catalogue
from sphstudy.configuration.composition import session
from sphstudy.errors import ConfigurationError
from sphstudy.running.launching import workers_of
from sphstudy.running.slurm import settings
from sphstudy.running.slurm.settings import settings_of


@pytest.fixture
def values():
    """What conf/ has."""
    path = catalogue.folder("conf") / "hydra" / "launcher" / "slurm.yaml"
    return OmegaConf.to_container(OmegaConf.load(path))


@pytest.fixture
def there(monkeypatch):
    """submitit and SLURM are there."""
    monkeypatch.setitem(sys.modules, "submitit", SimpleNamespace())
    monkeypatch.setattr(settings.shutil, "which", lambda name: name)


@pytest.mark.usefixtures("there")
def test_the_settings_of_the_project_are_right(values):
    assert settings_of(values).points_per_job == 1


@pytest.mark.usefixtures("there")
@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("timeout_min", 0, "greater than or equal to 1"),
        ("timeout_min", 1.5, "integer"),
        ("mem_gb", 0.0, "greater than 0"),
        ("points_per_job", "many", "integer"),
        ("partition", "a\nb", "match pattern"),
        ("setup", ["true\nfalse"], "match pattern"),
        ("setup", "true", "tuple"),
        ("additional", ["--account=a"], "match pattern"),
        ("additional", ["account=a\n#SBATCH --uid=0"], "match pattern"),
        ("additional", ["job-name=mine"], "additional=job-name: is set by the program itself"),
        ("gpus", 1, "there is no such key"),
    ],
)
def test_wrong_settings_are_named(values, key, value, said):
    with pytest.raises(ConfigurationError, match=r"hydra\.launcher") as error:
        settings_of({**values, key: value})
    assert key in str(error.value)
    assert said in str(error.value)


def test_without_submitit_it_is_said_how_to_install_it(values, monkeypatch):
    monkeypatch.setitem(sys.modules, "submitit", None)
    monkeypatch.setattr(settings.shutil, "which", lambda name: name)
    with pytest.raises(ConfigurationError, match=r"pip install 'sphstudy\[cluster\]'"):
        settings_of(values)


def test_without_slurm_it_is_said_what_is_missing(values, monkeypatch):
    monkeypatch.setitem(sys.modules, "submitit", SimpleNamespace())
    monkeypatch.setattr(settings.shutil, "which", lambda name: None)
    with pytest.raises(ConfigurationError, match="there is no sbatch, srun, squeue, scancel"):
        settings_of(values)


@pytest.mark.usefixtures("there")
def test_the_command_line_answers_for_them():
    with session() as hydra:
        chosen = ["hydra/launcher=slurm", "hydra.launcher.setup=[module load python]"]
        launcher = hydra.launcher(chosen)
        assert launcher.settings["setup"] == ["module load python"]
        assert workers_of(launcher, []) == launcher.settings["array_parallelism"]
        wrong = hydra.launcher(["hydra/launcher=slurm", "hydra.launcher.timeout_min=0"])
    with pytest.raises(ConfigurationError, match="timeout_min"):
        workers_of(wrong, [])
