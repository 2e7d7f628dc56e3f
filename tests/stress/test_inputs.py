"""Bad input: some by hand, and a reduced number of made-up ones (see inputs.py)."""

import netCDF4
import numpy as np
import pytest

from tests.stress import inputs
from tests.stress.inputs import POISON, Damaged, campaign, outcome, place


@pytest.fixture(scope="module")
def damaged(tmp_path_factory):
    return Damaged(tmp_path_factory.mktemp("records"))


@pytest.fixture
def here():
    with place() as folder:
        yield folder


EVIL = [
    ["_target_=os.system"],
    ["scene._target_=os.system"],
    ["scene={_target_:os.system,command:id}"],
    ["scene.E={_target_:os.getcwd}"],
    ["record={_target_:os.getcwd}"],
    ["hydra.launcher._target_=os.system"],
    ["hydra/launcher=submitit_local"],
    ["hydra.sweep.dir=/tmp"],
    [f"scene.name=${{oc.env:{POISON}}}"],
    [f"results=${{oc.env:{POISON}}}"],
    ["h=${n}"],
    ["scene.name=../../x"],
    ["scene.name=a/b"],
    ["scene.name=<script>alert(1)</script>"],
    ["method.name=.."],
    ["scene.kind=problem"],
    ["scene.kind=__init__"],
    ["scene.kind=1"],
    ["scene.kind=[os]"],
    ["solve.name=stepping"],
    ["h=null"],
    ["scene=null"],
    ["record=1"],
    ["n=" + "9" * 5000],
    ["n=range(1,1e9)", "-m"],
    ["h=range(1,2,1e-9)", "n=1,2,3", "-m"],
    ["h=interval(1,2)", "-m"],
    ["scene=range(1,1e9)"],
    ["scene=range(1,2,0)"],
    ["n=range(3,1)", "-m"],
    ["h=range(1.3,1.5,0)", "-m"],
    ["h=range(1,2,nan)", "-m"],
    ["h=glob(*)", "-m"],
    ["h=" + "[" * 500 + "]" * 500],
    ["known=1"],
    ["results=a\0b"],
]


@pytest.mark.parametrize("arguments", EVIL, ids=[" ".join(a)[:40].replace("\0", "0") for a in EVIL])
def test_overrides_that_are_refused(here, arguments):
    assert outcome(arguments)[0] == "refused"


FILES = {
    "python tag": b"title: !!python/object/apply:os.system ['touch run_by_a_shell']",
    "environment": f"title: t\nblocks: {{g: {{scene: '${{oc.env:{POISON}}}', n: 5}}}}".encode(),
    "interpolation": b"title: t\nblocks: {g: {scene: plate, n: '${seed}'}}",
    "target": b"title: t\nblocks: {g: {scene: plate, n: 5, _target_: os.system}}",
    "recursive": b"a: &a [*a]",
    "deep": b"[" * 600,
    "nothing": b"",
    "a list": b"- title",
    "not text": b"\xff\xfe\x00",
    "numbers for names": b"1: 2",
}


@pytest.mark.parametrize("text", FILES.values(), ids=FILES)
def test_study_files_that_are_refused(here, text):
    (here / "studies" / "generated.yaml").write_bytes(text)
    for command in (["study", "generated"], ["status", "generated"], ["study", "generated", "--dry-run"]):
        found, said, _ = outcome(command)
        assert found == "refused", said
    assert not (here / "run_by_a_shell").exists()


def test_a_bit_of_a_number_is_noticed(damaged):
    """HDF5 keeps no checksum of single numbers: without the seal, another number would be read."""
    damaged.path.write_bytes(damaged.bytes)
    with netCDF4.Dataset(damaged.path) as run:
        value = np.float64(run["spacing_x"][...])
    at = damaged.bytes.index(value.tobytes())
    assert damaged.try_record(("changed", {at: 1})) == "changed"


@pytest.mark.parametrize("kind", ["directory", "loop", "dangling"])
def test_what_is_no_file_is_no_record(damaged, kind):
    assert damaged.try_record((kind, None)) == kind


def test_any_part_of_the_end_may_be_missing(damaged):
    for length in (1, 20, 47, 48, 49, 100):
        assert damaged.try_record(("cut", len(damaged.bytes) - length)) == "cut"


def test_made_up_overrides(here):
    found = campaign(inputs.OVERRIDES, inputs.try_overrides, 25, seed=3)
    assert found["refused"] > 0


def test_made_up_study_files(here):
    found = campaign(inputs.STUDIES, inputs.try_study, 25, seed=3)
    assert found["refused"] > 0


def test_made_up_records(damaged):
    assert campaign(damaged.cases(), damaged.try_record, 15, seed=3).total() == 15
