"""Which stored runs are sound, and when others went bad.

    sphstudy judge STUDY [key=value ...] [options]

Prints which stored runs keep within their bounds, and when and by which bound
others went bad. Settings (key=value) replace what the study's file says.

    sphstudy judge stability                   every method on every hard case
"""

from sphstudy.analysis.results import load
from sphstudy.analysis.stability.cases import judged
from sphstudy.commands.parser import Request
from sphstudy.configuration.composition import session
from sphstudy.console import print_table
from sphstudy.report.stability_tables import bounds, counts, quoted, stability_map


def run(request: Request) -> int:
    """Prints which runs are sound, degraded or diverged, when and by what, and the bounds."""
    with session(request.config_dir) as hydra:
        results = load(request.words[0], hydra, list(request.settings))
        cases = judged(results)
    for table in (stability_map(cases), bounds(cases), quoted(results, cases)):
        if table is not None:
            print_table(table)
    print(f"judged: {counts(cases)}")
    return 0
