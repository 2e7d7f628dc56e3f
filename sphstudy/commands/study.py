"""A named study: run what is missing, compare, report.

    sphstudy study NAME [key=value ...] [options]

Runs all points of a study that are not stored, compares them with its stored
reference, checks its claims and writes its page to results/reports.
Settings (key=value) replace what the study's file says.

    sphstudy study mode1                       the mode I grid of the thesis
    sphstudy study thesis --dry-run            what would run, and the cost
    sphstudy study plate n=9,15                only these resolutions
"""

from sphstudy.analysis.claims import claim
from sphstudy.analysis.stability import bounds
from sphstudy.commands.parser import Request
from sphstudy.commands.plan_table import print_plan
from sphstudy.commands.points_table import print_outcome
from sphstudy.commands.report import review
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.configuration.overrides import launcher_overrides
from sphstudy.configuration.study_points import all_points
from sphstudy.report import figure
from sphstudy.running import sweep
from sphstudy.running.launching import workers_of
from sphstudy.running.plan import plan
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store


def run(request: Request) -> int:
    """Runs, compares, reports; with --dry-run only tells what would run and what it would cost.

    Returns 1 if a point has no result, if one diverged where the study forbids it, or if a metric lies
    outside its accepted interval.
    """
    name, force = request.words[0], request.has("force")
    launcher = launcher_overrides(list(request.settings))
    settings = [s for s in request.settings if s not in launcher]
    with session(request.config_dir) as hydra:
        points, folder, skipped = all_points(hydra, name, settings)
        _check(name)
        for complaint in skipped:
            print(f"left out: {complaint}")
        store = Store(folder)
        if request.has("dry-run"):
            workers = workers_of(hydra.launcher(launcher), points)
            print_plan(plan(points, store, force), store, workers)
            return 0
        called = study_file.results_name(name, settings)
        found, path = sweep.sweep(hydra, points, store, launcher, force, called)
        status = print_outcome(found, path)
        diverged = (found["status"] == STATUS.index("diverged")).any()
        if study_file.load(name).forbid_diverged and diverged:
            print("a point diverged, which this study forbids")
            status = 1
        return max(status, review(hydra, name, settings, folder))


def _check(name: str) -> None:
    """Raises ConfigurationError if a study names a claim, figure or study that does not exist, or if its
    runs are judged and a file of bounds is wrong.
    """
    for member in dict.fromkeys([*study_file.members(name), *study_file.load(name).shows]):
        definition = study_file.load(member)
        for claim_id in definition.claims:
            claim.find(claim_id)
        for figure_name in definition.figures:
            figure.find(figure_name)
        if definition.judged:
            bounds.check()
