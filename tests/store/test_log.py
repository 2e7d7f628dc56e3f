"""Logs of runs: what they say, and that they never cost a run."""

import os
import platform
import re
import time
import warnings
from pathlib import Path

import pytest

from sphstudy.store.log import run_log

LINE = re.compile(r"(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d) UTC, (\S+), process (\d+): (.*)")


def test_every_entry_carries_date_host_and_process(tmp_path):
    earliest = time.time()
    with run_log(tmp_path / "run.log") as log:
        log.info("begun")
        log.info("failed\n  in two lines")
    latest = time.time()
    first, second, third = (tmp_path / "run.log").read_text().splitlines()
    for line, text in ((first, "begun"), (second, "failed")):
        date, host, process, said = LINE.fullmatch(line).groups()
        assert (host, process, said) == (platform.node(), str(os.getpid()), text)
        written = time.strptime(f"{date} +0000", "%Y-%m-%d %H:%M:%S %z")
        assert int(earliest) <= time.mktime(written) - time.timezone <= latest
    assert third == "  in two lines"


@pytest.mark.parametrize("place", ["/dev/full", "gone/run.log"], ids=["full", "missing"])
def test_a_disk_that_takes_nothing_costs_lines_and_not_the_run(tmp_path, monkeypatch, capsys, place):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OSError, match=r"No space|No such"):
        Path(place).write_text("not possible")
    with warnings.catch_warnings(), run_log(Path(place)) as log:
        log.info("begun")
        warnings.simplefilter("always")
        warnings.warn("odd", stacklevel=1)
    assert list(tmp_path.iterdir()) == []
    assert capsys.readouterr().err == ""


def test_warnings_go_to_the_log_and_nowhere_else(tmp_path):
    with pytest.warns(RuntimeWarning) as elsewhere:  # noqa: PT031
        with run_log(tmp_path / "run.log"):
            warnings.warn("odd numbers", RuntimeWarning, stacklevel=1)
        warnings.warn("not for the log", RuntimeWarning, stacklevel=1)
    assert [str(warning.message) for warning in elsewhere] == ["not for the log"]
    text = (tmp_path / "run.log").read_text()
    assert LINE.match(text)
    assert "RuntimeWarning: odd numbers" in text
    assert Path(__file__).name in text
    assert "not for the log" not in text


def test_the_hook_is_put_back_when_the_run_fails(tmp_path):
    show = warnings.showwarning
    with pytest.raises(ZeroDivisionError), run_log(tmp_path / "run.log"):
        1 / 0  # noqa: B018
    assert warnings.showwarning is show
