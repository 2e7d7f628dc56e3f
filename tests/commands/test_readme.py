"""What README and helps show can be typed: every line is understood, the cheap ones are run."""

import re
import shlex
import textwrap
from pathlib import Path

import pytest

from sphstudy.__main__ import main
from sphstudy.commands.grammar import COMMANDS, about
from sphstudy.commands.parser import help_text, parse
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.configuration.overrides import launcher_overrides

README = (Path(__file__).parent.parent.parent / "README.md").read_text(encoding="utf-8")
CHEAP = ("list", "describe", "status", "prune", "adopt")


def typed(text):
    """Command lines in the indented blocks of a text; two spaces begin the remark behind one."""
    blocks = re.findall(r"^    (?:\S*python -m )?sphstudy (.*)$", text, re.MULTILINE)
    return [shlex.split(line.partition("  ")[0]) for line in blocks]


LINES = [*typed(README), *map(shlex.split, re.findall(r"`sphstudy ([^`]+)`", README.replace("\n", " ")))]
EXAMPLES = [line for name in COMMANDS for line in typed("\n".join(about(name)[3:]))]
UNDERSTOOD = [line for line in [*LINES, *EXAMPLES] if "--help" not in line]


def test_readme_has_every_command_and_no_other():
    assert {parse(line).name for line in LINES if "--help" not in line} == set(COMMANDS)


def test_every_command_line_is_understood():
    for line in UNDERSTOOD:
        request = parse(line)
        if request.name in ("study", "report", "judge", "measure", "reference", "status"):
            assert all(word.isupper() or word in study_file.names() for word in request.words), line


def scenes_of_its_reader(folder):
    """The files of scenes that README shows, where its command lines look for them."""
    for text in re.findall(r"^(    # @package _global_\n(?:    .*\n)+)", README, re.MULTILINE):
        path = folder / "my_conf" / "scene" / "stubby.yaml"
        path.parent.mkdir(parents=True)
        path.write_text(textwrap.dedent(text), encoding="utf-8")


def test_every_line_of_runs_makes_points(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SPHSTUDY_CONFIG_DIR", "")  # put back afterwards
    scenes_of_its_reader(tmp_path)
    for request in map(parse, UNDERSTOOD):
        if request.name == "run":
            settings = list(request.settings)
            settings = [s for s in settings if s not in launcher_overrides(settings)]
            with session(request.config_dir) as hydra:
                assert hydra.points(settings, sweep=request.has("multirun"))[0], request


@pytest.mark.parametrize(
    "line",
    [r for r in LINES if "--dry-run" in r or (r[0] in CHEAP and not r[-1].isupper())],
    ids=" ".join,
)
def test_a_cheap_one_runs(line, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results" / "runs").mkdir(parents=True)
    assert main(line) == 0
    assert capsys.readouterr().out


def test_bare_it_prints_the_help(capsys):
    assert main([]) == 0
    shown = capsys.readouterr().out
    assert main(["--help"]) == 0
    assert capsys.readouterr().out == shown
    for name in COMMANDS:
        assert f"\n  {name} " in shown


@pytest.mark.parametrize("name", [*COMMANDS, ""])
def test_every_help_is_its_own_has_all_options_and_fits_a_terminal(name):
    shown = help_text([name, "-h"])
    assert max(map(len, shown.splitlines())) < 80
    if name:
        first, usage, *_ = about(name)
        assert shown.startswith(f"{first}\n\n{usage}\n")
        assert f"    sphstudy {name}" in usage or name == "run"
        for option in COMMANDS[name].options:
            assert all(spelling in shown for spelling in option.spellings)
            assert option.meaning in " ".join(shown.split())


def test_old_ways_to_write_an_option_mean_the_same():
    for old, new in (
        ("compare a b tolerance=1e-5 all=true", "compare a b --tolerance 1e-5 --all"),
        ("study speed quick=true parts=forms --dry-run", "speed --quick --parts=forms --dry-run"),
        ("peers peers=pysph n=9 results=x", "peers --results x --peers pysph --n=9"),
        ("extrapolate x G2 results=y --order=1", "extrapolate x --order 1 G2 --results y"),
        ("advise scene=plate error=1%", "advise --scene plate --error 1%"),
        ("prune results=x --yes", "prune --yes --results=x"),
        ("h=1.5 -m results=x", "-m --results x h=1.5"),
        ("run n=5 --force", "n=5 -f"),
    ):
        assert parse(old.split()) == parse(new.split())
