"""Figures and page of a study again, from stored data.

    sphstudy report STUDY [key=value ...] [options]

Compares, checks claims and writes the page as `study` does; runs nothing.
Settings (key=value) replace what the study's file says.

    sphstudy report mode1                      results/reports/mode1/index.html
"""

import time
from pathlib import Path

from sphstudy.analysis import compare
from sphstudy.analysis.claims import claim
from sphstudy.analysis.compare import OUTSIDE
from sphstudy.analysis.results import load
from sphstudy.commands.compare import SHOWN, print_comparison
from sphstudy.commands.parser import Request
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Session, session
from sphstudy.configuration.study_points import all_points
from sphstudy.report import page
from sphstudy.store.store import Store


def run(request: Request) -> int:
    """Reviews a study; 1 if a metric lies outside its accepted interval."""
    name, settings = request.words[0], list(request.settings)
    with session(request.config_dir) as hydra:
        folder = all_points(hydra, name, settings)[1]
        Store(folder).prepare()
        return review(hydra, name, settings, folder)


def review(hydra: Session, name: str, settings: list[str], folder: str) -> int:
    """Prints the claims of a study and its comparison with references, and writes its page.

    Parameters
    ----------
    hydra : Session
        Composes the points.
    name : str
        The study.
    settings : list of str
        What replaces settings of its file, `key=value`.
    folder : str
        Folder of the results.

    Returns
    -------
    int
        1 if a metric lies outside its accepted interval, else 0.
    """
    found = load(name, hydra, settings, folder)
    for one, finding in claim.checked(found):
        print(f"claim {one.id}: {finding.verdict}: {finding.numbers}")
    compared, outside = compare.against_reference(found), 0
    if compared:
        outside = print_comparison(compared, SHOWN)[OUTSIDE]
    else:
        print(f"{name}: there is no stored reference to compare with")
    began = time.perf_counter()
    path = page.write(found, Path(folder) / "reports" / study_file.results_name(name, settings))
    print(f"report: {path} ({time.perf_counter() - began:.0f} s)")
    return 1 if outside else 0
