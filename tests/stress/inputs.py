"""Bad input by the thousand: overrides, study files and bytes of records made up by hypothesis.

`python -m tests.stress.inputs 1000` tries so many and prints what became of them. None may end in a
traceback, start a run that it should not, or be taken without a word.
"""

import contextlib
import io
import json
import math
import os
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import hypothesis
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import sphstudy
from sphstudy import catalogue
from sphstudy.__main__ import main
from sphstudy.catalogue import scene_module
from sphstudy.configuration.composition import session
from sphstudy.configuration.run_settings import validate
from sphstudy.running import sweep
from sphstudy.running.launching import workers_of
from sphstudy.running.plan import plan
from sphstudy.store.store import Store
from tests.stress.strategies import CHEAP, OVERRIDES, POISON, STUDIES, damages

SLOW = 60.0
"""No input may keep a command busy for so long (s)."""


class WouldRun(BaseException):
    """Ends a command where its runs would begin, with the points it would have run."""

    def __init__(self, points):
        super().__init__()
        self.points = points


def _stop(hydra, points, store, launcher, force=False, name=None):
    workers_of(hydra.launcher(launcher), points)
    small = [p for p in points if scene_module(p.config.scene.kind).particles(p.config) < 3000]
    plan(small, store)
    raise WouldRun(points)


@contextlib.contextmanager
def place():
    """An empty folder to work in, where nothing really runs; studies are read from its `studies`."""
    before, run, folder = Path.cwd(), sweep.sweep, catalogue.FOLDERS["studies"]
    with tempfile.TemporaryDirectory() as name:
        inner = Path(name, "a", "b")
        (inner / "studies").mkdir(parents=True)
        os.environ[POISON] = "poison"
        sweep.sweep, catalogue.FOLDERS["studies"] = _stop, inner / "studies"
        os.chdir(inner)
        try:
            yield inner
        finally:
            os.chdir(before)
            sweep.sweep, catalogue.FOLDERS["studies"] = run, folder
            del os.environ[POISON]


def outcome(arguments: list[str]) -> tuple[str, str, list]:
    """What a command does: "refused", "would run" or "told", with what it prints and its points.

    Raises AssertionError if it is refused without a reason or accepts a point that is not valid, and
    whatever comes out of it.
    """
    printed, said = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(said):
            status = main(arguments)
    except WouldRun as stopped:
        for point in stopped.points:
            assert validate(point.config.as_dict()) == point.config, point.config
            assert "poison" not in json.dumps(point.config.as_dict())
            assert Path(point.config.label).name == point.config.label
        return "would run", said.getvalue(), stopped.points
    text = printed.getvalue() + said.getvalue()
    assert "Traceback" not in text, text
    assert "poison" not in text, text
    if status:
        assert status == 2, (status, text)
        assert said.getvalue().startswith("sphstudy: "), text
        assert len(said.getvalue()) > len("sphstudy: \n"), "refused without a word"
        return "refused", text, []
    return "told", text, []


def try_overrides(case: tuple[list[str], list[str], bool]) -> str:
    """One command with made-up overrides."""
    usual, bad, many = case
    arguments = [*usual, *bad, *(["-m"] if many else [])]
    found, _, points = outcome([a for a in arguments if a])
    assert not Path("run_by_a_shell").exists()
    if found == "would run":
        _taken(bad, points)
    return found


def _taken(given_: list[str], points: list) -> None:
    """Raises AssertionError if a plain number or word that was given is in none of the points."""
    for argument in given_:
        key, _, value = argument.partition("=")
        values = [p.config.flat().get(key) for p in points]
        if any(mark in value for mark in "(,[{'\"\\ \t") or key not in points[0].config.flat():
            continue
        assert any(_same(value, v) for v in values), (argument, values)


def _same(text: str, value: object) -> bool:
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return text.strip().lower() == ("null" if value is None else str(value)).lower()
    number = float(text.replace("_", ""))
    return math.isclose(number, float(str(value)), rel_tol=1e-11)


def try_study(text: bytes) -> str:
    """A study file of these bytes, run."""
    Path("studies", "generated.yaml").write_bytes(text)
    found, _, _ = outcome(["study", "generated"])
    assert not Path("run_by_a_shell").exists()
    return found


class Damaged:
    """A record, and what becomes of it when its bytes are not what they were."""

    def __init__(self, folder: Path):
        self.store = Store(folder / "damaged")
        sphstudy.run(results=self.store.folder, **CHEAP)
        arguments = [f"{key}={value}" for key, value in CHEAP.items()]
        with session() as hydra:
            self.points = hydra.points([*arguments, f"results={self.store.folder}"], sweep=False)[0]
        self.path = self.store.record_path(self.points[0].config)
        self.bytes = self.path.read_bytes()
        sphstudy.run(results=folder / "other", **{**CHEAP, "n": 7})
        (other,) = (folder / "other" / "runs").glob("*.nc")
        self.foreign = {
            "record of another run": other.read_bytes(),
            "combined dataset": next((folder / "other" / "sweeps").glob("*.nc")).read_bytes(),
            "empty": b"",
            "text": b"not a record\n" * 100,
            "netCDF 3": b"CDF\x01" + bytes(100),
            "HDF5 head": self.bytes[:512],
        }

    def cases(self) -> st.SearchStrategy:
        """What may become of this record."""
        return damages(len(self.bytes), sorted(self.foreign))

    def try_record(self, case: tuple) -> str:
        """One damaged record: named, set aside as it is, and its point would be run."""
        kind, detail = case
        for path in self.store.runs.glob("*.unreadable"):
            path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()
        self.path.rmdir() if self.path.is_dir() and not self.path.is_symlink() else self.path.unlink(
            missing_ok=True
        )
        data = self._put(kind, detail)
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            (planned,) = plan(self.points, Store(self.store.folder))
        assert planned.runs, (planned.status, planned.reason)
        assert planned.status in ("missing", "interrupted")
        if kind == "dangling":
            return kind
        assert f"{self.path.name}: unreadable" in said.getvalue(), said.getvalue()
        aside = self.path.with_suffix(".unreadable")
        assert os.path.lexists(aside)
        assert data is None or aside.read_bytes() == data
        assert not os.path.lexists(self.path)
        assert outcome(["status", f"results={self.store.folder}"])[0] == "told"
        assert outcome(["prune", f"results={self.store.folder}"])[0] == "told"
        return kind

    def _put(self, kind: str, detail) -> bytes | None:
        data = bytearray(self.bytes)
        if kind == "directory":
            self.path.mkdir()
            return None
        if kind in ("loop", "dangling"):
            self.path.symlink_to(self.path if kind == "loop" else self.path.with_name("nowhere"))
            return None
        if kind == "cut":
            data = data[:detail]
        elif kind == "changed":
            for position, change in detail.items():
                data[position] ^= change
        elif kind == "foreign":
            data = self.foreign[detail]
        elif kind == "bytes":
            data = detail
        else:
            data += detail
        self.path.write_bytes(data)
        return bytes(data)


def campaign(cases: st.SearchStrategy, attempt, count: int, seed: int) -> Counter[str]:
    """Tries so many cases; counts what became of them."""
    found: Counter[str] = Counter()

    @hypothesis.seed(seed)
    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(cases)
    def each(case):
        begun = time.monotonic()
        found[attempt(case)] += 1
        assert time.monotonic() - begun < SLOW, f"{case} took {time.monotonic() - begun:.0f} s"

    each()
    return found


def run(count: int, seed: int) -> dict[str, Counter[str]]:
    """Half of the cases are overrides, a quarter study files, a quarter bytes of records."""
    with tempfile.TemporaryDirectory() as name:
        # Outside of the place where nothing runs: these records are real.
        damaged = Damaged(Path(name))
        with place():
            return {
                "overrides": campaign(OVERRIDES, try_overrides, max(count // 2, 1), seed),
                "study files": campaign(STUDIES, try_study, max(count // 4, 1), seed),
                "records": campaign(damaged.cases(), damaged.try_record, max(count // 4, 1), seed),
            }


if __name__ == "__main__":
    begun = time.monotonic()
    results = run(*(int(a) for a in (sys.argv[1:] + ["1000", "1"][len(sys.argv) - 1 :])))
    for name, counts in results.items():
        print(
            f"{name}: {counts.total()} tried; " + ", ".join(f"{n} {o}" for o, n in counts.most_common())
        )
    print(f"{sum(c.total() for c in results.values())} in {time.monotonic() - begun:.0f} s")
