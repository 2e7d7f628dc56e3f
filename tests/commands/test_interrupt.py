"""Ctrl-C at any moment: the prompt is back in two seconds, what is done is kept, nobody is left.

What Python does before it comes to the program is not the program's, nor are the few milliseconds that
loading `sphstudy.__main__` takes: moments count from the first import that the program asks for.
"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

LINE = "sphstudy: interrupted; finished runs are kept"
SCRIPT = """
import sys
from sphstudy.__main__ import main
if __name__ == "__main__":
    sys.exit(main())
"""
"""What an installer writes for the console script."""
WITNESS = """
import sys
from pathlib import Path

def note(event, details):
    if event == "import" and details[0] == "sphstudy.configuration.run_settings":
        Path("begun").touch()

sys.addaudithook(note)
"""
"""A sitecustomize that leaves a file as soon as the program imports something."""


def group(leader):
    """Living processes of the leader's session, zombies apart."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session = path.read_text().rpartition(")")[2].split()[:4]
        except OSError:
            continue
        if int(session) == leader and state != "Z":
            found.append(path.parent.name)
    return found


SWEEP = ("-m", "scene=plate", "n=5,15", "h=1.5,1.7", "hydra.launcher.n_jobs=2")
"""Two workers, busy for some seconds."""


def start(folder, entry=("-m", "sphstudy"), settings=SWEEP, **environment):
    """The program, in a session of its own."""
    (folder / "sitecustomize.py").write_text(WITNESS)
    (folder / "script").write_text(SCRIPT)
    paths = [str(folder), *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.Popen(
        [sys.executable, *entry, *settings],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths), **environment},
        start_new_session=True,
        # Whatever runs the tests in the background may have told its children to ignore Ctrl-C.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def wait_for(path):
    """Until the file is there."""
    deadline = time.monotonic() + 60
    while not path.exists():
        assert time.monotonic() < deadline, f"no {path.name}"
        time.sleep(0.001)


def nobody_is_left(leader):
    """Waits two seconds at most."""
    deadline = time.monotonic() + 2.0
    while group(leader) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert group(leader) == []


def leaves(process, interrupt=os.killpg):
    """At Ctrl-C, as it should."""
    begun = time.monotonic()
    interrupt(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert time.monotonic() - begun < 2.0
    assert process.returncode == 130
    assert errors.splitlines().count(LINE) == 1
    assert "Traceback" not in errors
    nobody_is_left(process.pid)


def spoilt(runs):
    """Files that are half written, and logs of runs that are said to have failed."""
    failed = [path for path in runs.glob("*.log") if "failed" in path.read_text()]
    return [*runs.glob(".writing-*"), *failed]


@pytest.mark.parametrize("entry", [("-m", "sphstudy"), ("script",)], ids=["module", "console script"])
@pytest.mark.parametrize(
    "moment", [0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0, 3.0, 5.0]
)
def test_at_any_moment_the_prompt_is_back(tmp_path, entry, moment):
    """While modules are imported, points composed, workers started, runs under way."""
    process = start(tmp_path, entry)
    wait_for(tmp_path / "begun")
    time.sleep(moment)
    leaves(process)
    assert spoilt(tmp_path / "results" / "runs") == []


@pytest.mark.parametrize("moment", [2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
def test_while_a_single_run_compiles_too(tmp_path, moment):
    """In this process. LLVM drops the KeyboardInterrupt, or crashes as what it was at is tidied up."""
    single = ("scene=plate", "n=5")
    process = start(tmp_path, settings=single, NUMBA_CACHE_DIR=str(tmp_path / "cache"))
    wait_for(tmp_path / "begun")
    time.sleep(moment)
    leaves(process)
    runs = tmp_path / "results" / "runs"
    assert spoilt(runs) == []
    assert list(runs.glob("*.nc")) == [], "it was over before"


def test_an_interrupt_that_a_library_swallows_while_it_is_imported_ends_the_program():
    program = """
import signal, sys
from sphstudy.__main__ import main

class Swallowing:
    def find_spec(self, name, path, target=None):
        if name == "sphstudy.commands.run":
            try:
                signal.raise_signal(signal.SIGINT)
            except KeyboardInterrupt:
                raise ImportError(name)

signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Swallowing())
sys.exit(main(["h=1.5"]))
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert (ended.returncode, ended.stderr) == (130, f"{LINE}\n")


def test_an_interrupt_that_a_library_makes_another_error_of_is_still_one():
    """As Hydra does, in the few milliseconds in which it reads a file."""
    program = """
import signal, sys
from sphstudy.__main__ import main
from sphstudy.commands import run

def interrupted(request):
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        raise ValueError("cannot be read")

signal.signal(signal.SIGINT, signal.default_int_handler)
run.run = interrupted
sys.exit(main(["h=1.5"]))
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert (ended.returncode, ended.stderr) == (130, f"{LINE}\n")


@pytest.mark.parametrize("terminal", [False, True])
def test_while_numba_compiles_nothing_is_raised_but_the_program_left(terminal):
    """A display of the runs has hidden the cursor of a terminal."""
    program = """
import signal, sys
from numba.core.compiler_lock import global_compiler_lock
from sphstudy.__main__ import main
from sphstudy.commands import run

def interrupted(request):
    with global_compiler_lock:
        try:
            signal.raise_signal(signal.SIGINT)
        finally:
            print("raised")

signal.signal(signal.SIGINT, signal.default_int_handler)
run.run = interrupted
sys.exit(main(["h=1.5"]))
"""
    ours, theirs = os.openpty() if terminal else os.pipe()
    ended = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "TERM": "xterm"},
        stdout=subprocess.PIPE,
        stderr=theirs,
        timeout=60,
    )
    os.close(theirs)
    said = os.read(ours, 1000).decode().replace("\r\n", "\n")
    os.close(ours)
    assert (ended.returncode, ended.stdout) == (130, b"")
    assert said == ("\n\x1b[?25h" if terminal else "") + f"{LINE}\n"


def test_whoever_told_it_to_ignore_interrupts_is_obeyed(tmp_path):
    """As a shell does for what it runs in the background."""
    process = subprocess.Popen(
        [sys.executable, "-m", "sphstudy", "list"],
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN),
        stdout=subprocess.PIPE,
        text=True,
    )
    while process.poll() is None:
        process.send_signal(signal.SIGINT)
        time.sleep(0.02)
    assert "mode1" in process.communicate()[0]
    assert process.returncode == 0


@pytest.mark.parametrize("to_group", [True, False], ids=["terminal", "parent only"])
def test_interrupt(tmp_path, to_group):
    process = start(tmp_path)
    marker = time.monotonic() + 120
    runs = tmp_path / "results" / "runs"
    while not any('"step": 0' not in p.read_text() for p in runs.glob("*.running.json")):
        assert time.monotonic() < marker, "no run got under way"
        time.sleep(0.2)
    leaves(process, os.killpg if to_group else os.kill)
    assert spoilt(runs) == []
