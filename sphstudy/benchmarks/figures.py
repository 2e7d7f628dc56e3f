"""Figures of the benchmarks as files."""

from collections.abc import Callable
from pathlib import Path

import matplotlib
import xarray as xr
from matplotlib.figure import Figure

from sphstudy.report.figure import STYLE


def write_figure(draw: Callable[[xr.Dataset], Figure], found: xr.Dataset, path: Path) -> Path:
    """Draws a figure of a dataset in the style of the report; writes PNG, and PDF beside it.

    Parameters
    ----------
    draw : callable
        From the dataset to the figure.
    found : xarray.Dataset
        The dataset.
    path : Path
        The PNG file, which is returned.
    """
    with matplotlib.rc_context(fname=STYLE):
        drawing = draw(found)
        drawing.savefig(path, metadata={"Software": None})
        drawing.savefig(path.with_suffix(".pdf"), metadata={"CreationDate": None})
    return path
