"""Options of Hydra: those that are taken do as Hydra does, the others are answered with what to write."""

import shutil
import subprocess

import pytest
import yaml

from sphstudy import catalogue
from sphstudy.__main__ import main
from sphstudy.configuration.composition import session
from tests.support.made_up import Solver


@pytest.fixture
def own(tmp_path, monkeypatch):
    """A folder of settings with a scene of the user's."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SPHSTUDY_CONFIG_DIR", "")
    (tmp_path / "own" / "scene").mkdir(parents=True)
    text = "# @package _global_\ndefaults: [plate, _self_]\nscene: {periods: 0.02, E: 2.0e6}\n"
    (tmp_path / "own" / "scene" / "soft.yaml").write_text(text)
    return tmp_path / "own"


def test_cfg_job_prints_what_would_run_and_runs_nothing(own, capsys):
    assert main(["--cfg", "job", "scene=plate", "h=1.7", "results=elsewhere"]) == 0
    shown = yaml.safe_load(capsys.readouterr().out)
    with session() as hydra:
        config = hydra.points(["scene=plate", "h=1.7"], sweep=False)[0][0].config
    assert shown["results"] == "elsewhere"
    for key, value in config.flat().items():
        part, _, name = key.partition(".")
        assert (
            shown[part].get(name or "name") if isinstance(shown[part], dict) else shown[part]
        ) == value
    assert [path.name for path in own.parent.iterdir()] == ["own"]


def test_a_scene_in_a_folder_of_the_users_is_found(own, monkeypatch, capsys):
    Solver(monkeypatch)
    assert main(["scene=soft", "h=1.5", "n=5"]) == 2
    assert "unknown scene 'soft'" in capsys.readouterr().err
    assert main(["--config-dir", str(own), "scene=soft", "method=tl", "h=1.5", "n=5"]) == 0
    assert " done " in capsys.readouterr().out
    assert [path.name.partition("-")[0] for path in (own.parent / "results" / "runs").glob("*.nc")] == [
        "soft"
    ]


def test_info_searchpath_prints_folders_of_settings(own, capsys):
    assert main(["--info", "searchpath", "-cd", str(own)]) == 0
    shown = capsys.readouterr().out.splitlines()
    places = [line.removeprefix("file://") for line in shown]
    assert places.index(str(own)) < places.index(str(catalogue.folder("conf").resolve()))


@pytest.mark.parametrize(
    ("arguments", "instead"),
    [
        (["--info", "all"], "write --info searchpath"),
        (["--cfg", "hydra", "h=1"], "write --cfg job"),
        (["--package", "scene"], "--cfg job prints all settings"),
        (["--resolve"], "--cfg job prints values resolved"),
        (["--config-name", "other"], "write key=value"),
        (["--config-path=elsewhere"], "write --config-dir DIR"),
        (["--experimental-rerun", "x"], "repeat the command"),
        (["--hydra-help"], "write --help"),
        (["-r", "h=1.5"], "leave it out"),
        (["--shell-completion", "install=fish"], "there is install=bash"),
    ],
)
def test_what_is_not_taken_is_answered_with_what_to_write(arguments, instead, capsys):
    assert main(arguments) == 2
    said = capsys.readouterr().err
    assert instead in said
    assert said.count("\n") == 1


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("sphstudy comp", ["compare"]),
        ("sphstudy compare --t", ["--tolerance"]),
        ("sphstudy --mul", ["--multirun"]),
        ("sphstudy -m scene=mo", ["mode1", "mode2"]),
        ("sphstudy report tl_pl", ["tl_plate"]),
        ("sphstudy describe gray_plate_", ["gray_plate_insert"]),
        ("sphstudy solve=eq", ["equilibrium"]),
        ("sphstudy h=1.5 che", ["checkpoint="]),
    ],
)
def test_bash_completes(line, found, capsys):
    assert main(["-sc", "install=bash"]) == 0
    script = capsys.readouterr().out
    words = " ".join(f"'{word}'" for word in line.split())
    asks = f"COMP_LINE='{line}'; COMP_POINT={len(line)}; COMP_WORDS=({words}); COMP_CWORD=1; _sphstudy"
    text = f"compopt() {{ :; }}\n{script}\n{asks}\nprintf '%s\\n' \"${{COMPREPLY[@]}}\""
    ended = subprocess.run(["bash", "-c", text], capture_output=True, text=True, timeout=20)
    assert (ended.stderr, ended.stdout.split()) == ("", found)
