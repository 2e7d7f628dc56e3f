"""A reduced number of kills (`python -m tests.stress.kills 100`), and two sweeps at once."""

import re

import pytest

from tests.stress.kills import SWEEP, WRONG, campaign, command, contents

pytestmark = pytest.mark.slow


def test_nobody_loses_anything():
    found = campaign(3, seed=5)
    assert found["kills"] == 3
    assert {wrong: found[wrong] for wrong in WRONG} == dict.fromkeys(WRONG, 0)


def test_two_sweeps_at_once_compute_each_point_once(tmp_path):
    alone, shared = tmp_path / "alone", tmp_path / "shared"
    alone.mkdir()
    shared.mkdir()
    assert command(SWEEP, alone).wait() == 0
    both = [command(SWEEP, shared) for _ in range(2)]
    assert [one.wait() for one in both] == [0, 0]
    logs = {path.name: path.read_text() for path in (shared / "runs").glob("*.log")}
    begun = {name: len(re.findall(": begun, ", text)) for name, text in logs.items()}
    assert len(begun) == 4
    assert set(begun.values()) == {1}, begun
    assert contents(shared) == contents(alone)
