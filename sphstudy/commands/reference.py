"""Stored results of a study become its stored reference.

    sphstudy reference STUDY [options]

Keeps stored results as the reference that later runs are compared with, each
metric with an accepted interval. The sources must be committed.

    sphstudy reference mode1                   results/reference/mode1.nc
"""

from sphstudy.analysis import reference
from sphstudy.commands.parser import Request
from sphstudy.configuration.composition import session
from sphstudy.configuration.study_points import all_points


def run(request: Request) -> int:
    """Writes the references of a study and of those that it includes."""
    name = request.words[0]
    with session() as hydra:
        folder = all_points(hydra, name, [f"results={request.results}"])[1]
        for member, made in reference.make(hydra, name, folder).items():
            print(f"reference: {reference.write(made, member)}")
    return 0
