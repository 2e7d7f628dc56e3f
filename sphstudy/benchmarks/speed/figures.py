"""The figures of `study speed`, as files beside its dataset."""

from pathlib import Path

import matplotlib
import xarray as xr

from sphstudy.benchmarks.speed import drawings
from sphstudy.report.figure import STYLE


def write_figures(found: xr.Dataset, folder: Path) -> list[Path]:
    """Draws what the dataset has the numbers for, as PNG and PDF; returns the PNG files."""
    written = []
    for draw, group in ((drawings.growth, "growth"), (drawings.terms, "terms")):
        if "rate" in found.dims and group in found["rate_group"].values:
            path = folder / f"{group}.png"
            with matplotlib.rc_context(fname=STYLE):
                figure = draw(found)
                figure.savefig(path, metadata={"Software": None})
                figure.savefig(path.with_suffix(".pdf"), metadata={"CreationDate": None})
            written.append(path)
    return written
