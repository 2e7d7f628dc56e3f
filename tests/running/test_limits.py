"""Limits of memory and logs of runs."""

import os
import platform
import re
import subprocess
import sys
import time
import warnings
from pathlib import Path

import pytest

from sphstudy.running.limits import Log, warnings_to

LINE = re.compile(r"(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d) UTC, (\S+), process (\d+): (.*)")


def alone(program):
    """Lines that a program prints in a process of its own, which may be limited."""
    begin = "import resource, warnings\nfrom sphstudy.running.limits import GIBIBYTE, memory_limited\n"
    begin += "def limits(): return resource.getrlimit(resource.RLIMIT_DATA)\n"
    ended = subprocess.run(
        [sys.executable, "-c", begin + program], capture_output=True, text=True, timeout=60
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout.splitlines()


def test_whoever_asks_for_more_memory_gets_an_error_and_the_limit_is_put_back():
    said = alone("""
before = limits()
try:
    with memory_limited(0.25):
        small = bytearray(GIBIBYTE // 16)
        print(limits()[0] == GIBIBYTE // 4, limits()[1] == before[1])
        bytearray(GIBIBYTE // 2)
except MemoryError:
    print("refused")
print(limits() == before)
print(len(bytearray(GIBIBYTE // 2)) == GIBIBYTE // 2)
""")
    assert said == ["True True", "refused", "True", "True"]


def test_without_a_limit_nothing_is_limited():
    said = alone("""
before = limits()
with memory_limited(None):
    print(limits() == before)
""")
    assert said == ["True"]


def test_a_hard_limit_below_is_respected():
    """Of a queue, say. To ask for more than it allows would be an error."""
    said = alone("""
hard = GIBIBYTE // 4
resource.setrlimit(resource.RLIMIT_DATA, (hard // 2, hard))
with memory_limited(1.0):
    print(limits() == (hard, hard))
print(limits() == (hard // 2, hard))
with memory_limited(0.125):
    print(limits() == (hard // 2, hard))
""")
    assert said == ["True", "True", "True"]


def test_every_entry_carries_date_host_and_process(tmp_path):
    log = Log(tmp_path / "run.log")
    earliest = time.time()
    log.say("begun")
    log.say("failed\n  in two lines\n")
    latest = time.time()
    first, second, third = (tmp_path / "run.log").read_text().splitlines()
    for line, text in ((first, "begun"), (second, "failed")):
        date, host, process, said = LINE.fullmatch(line).groups()
        assert (host, process, said) == (platform.node(), str(os.getpid()), text)
        written = time.strptime(f"{date} +0000", "%Y-%m-%d %H:%M:%S %z")
        assert int(earliest) <= time.mktime(written) - time.timezone <= latest
    assert third == "  in two lines"


@pytest.mark.parametrize("place", ["/dev/full", "gone/run.log"], ids=["full", "missing"])
def test_a_disk_that_takes_nothing_costs_lines_and_not_the_run(tmp_path, monkeypatch, place):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OSError, match=r"No space|No such"):
        Path(place).write_text("not possible")
    log = Log(Path(place))
    log.say("begun")
    with warnings.catch_warnings(), warnings_to(log):
        warnings.simplefilter("always")
        warnings.warn("odd", stacklevel=1)
    assert list(tmp_path.iterdir()) == []


def test_warnings_go_to_the_log_and_nowhere_else(tmp_path):
    with pytest.warns(RuntimeWarning) as elsewhere:  # noqa: PT031
        with warnings_to(Log(tmp_path / "run.log")):
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
    with pytest.raises(ZeroDivisionError), warnings_to(Log(tmp_path / "run.log")):
        1 / 0  # noqa: B018
    assert warnings.showwarning is show
