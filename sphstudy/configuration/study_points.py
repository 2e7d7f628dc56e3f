"""From a named study to its points, block by block."""

import math

from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Point, Session
from sphstudy.configuration.overrides import MOST_POINTS
from sphstudy.errors import ConfigurationError


class StudyPoints:
    """The points of one study file, without those of studies that it includes.

    Parameters
    ----------
    hydra : Session
        Composes them.
    name : str
        The study.
    overrides : list of str
        What replaces settings of its file.

    Attributes
    ----------
    blocks : dict
        Points of each block, in order.
    skipped : list of str
        Complaints about cells that are left out because they are not valid.
    folder : str
        Folder of the results; "" if there are no points.

    Raises
    ------
    ConfigurationError
        If the file is wrong, or a point is not valid and the study does not leave such cells out.
    """

    def __init__(self, hydra: Session, name: str, overrides: list[str]):
        definition = study_file.load(name)
        self.blocks: dict[str, list[Point]] = {}
        self.skipped: list[str] = []
        self.folder = ""
        skipped = self.skipped if definition.skip_invalid else None
        grids = study_file.grids(definition, overrides)
        # Before any is composed: a million take minutes.
        spanned = sum(math.prod(1 + o.count(",") for o in sweep) for s in grids.values() for sweep in s)
        if spanned > MOST_POINTS:
            raise ConfigurationError(
                [f"study {name}: about {spanned:,} points, a study has at most {MOST_POINTS:,}"]
            )
        for block, sweeps in grids.items():
            points: dict[str, Point] = {}
            for sweep in sweeps:
                found, self.folder = hydra.points(sweep, sweep=True, skipped=skipped)
                points |= {str(point.config): point for point in found}
            self.blocks[block] = list(points.values())


def all_points(hydra: Session, name: str, overrides: list[str]) -> tuple[list[Point], str, list[str]]:
    """All points of a study and of those that it includes, each once; parameters as those of StudyPoints.

    Returns
    -------
    list of Point, str, list of str
        The points, the folder of their results, and complaints about cells that are left out.

    Raises
    ------
    ConfigurationError
        If there are none, or with every complaint if one is not valid.
    """
    found: dict[str, Point] = {}
    skipped: list[str] = []
    folder = ""
    for member in study_file.members(name):
        part = StudyPoints(hydra, member, overrides)
        folder = part.folder or folder
        skipped += part.skipped
        found |= {str(p.config): p for points in part.blocks.values() for p in points}
    if not found:
        raise ConfigurationError([f"study {name}: no points"])
    return list(found.values()), folder, skipped
