"""Limits of the memory of runs."""

import subprocess
import sys


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


def test_a_limit_that_the_process_has_reached_already_is_refused():
    """In a library it would end the process, or be tried for ever."""
    said = alone("""
before = limits()
for limit in (0.01, 0.05):
    try:
        with memory_limited(limit):
            print("begun")
    except MemoryError as error:
        print(f"memory_limit={limit}" in str(error), limits() == before)
""")
    assert said == ["True True"] * 2


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
