"""Stored references: the combined dataset of a study, with an accepted interval for each metric.

They lie in `results/reference`, tracked, one netCDF file a study; `thesis_values.yaml` beside them has
the ranges that the thesis's text and axes give.
"""

import itertools
from functools import cache
from pathlib import Path

import xarray as xr
import yaml
from pydantic import TypeAdapter

from sphstudy import catalogue
from sphstudy.analysis import results
from sphstudy.analysis.dataset import combine
from sphstudy.analysis.effects import effects
from sphstudy.analysis.intervals import Tolerance, tolerances
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import Session
from sphstudy.configuration.study_file import Values
from sphstudy.errors import ConfigurationError
from sphstudy.parameters import described, number, parameters
from sphstudy.store import netcdf, provenance
from sphstudy.store.store import Store


def _path(name: str) -> Path:
    return catalogue.folder("reference") / f"{name}.nc"


def load(name: str) -> xr.Dataset | None:
    """The stored reference of a study, None if there is none."""
    path = _path(name)
    return netcdf.read_dataset(str(path), path.parent) if path.is_file() else None


def metrics(dataset: xr.Dataset) -> list[str]:
    """Names of the metrics in a combined dataset."""
    return [str(name) for name, v in dataset.data_vars.items() if v.attrs.get("group") == "metric"]


def tolerance(dataset: xr.Dataset, metric: str) -> Tolerance | None:
    """How far from the values of a reference the metric may be; None if it is not to be judged."""
    attributes = dataset[metric].attrs
    if "half_width" not in attributes:
        return None
    return Tolerance(float(attributes["half_width"]), str(attributes["half_width_reason"]))


@parameters
class Printed:
    """A range that the thesis gives for a metric in certain cells."""

    study: str = described("study that has the metric")
    block: str = described("block of that study")
    metric: str = described("the metric")
    where: dict[str, Values] = described("settings of the cells; a list: any of these")
    lower: float = number("least value")
    upper: float = number("largest value")
    source: str = described("where the thesis says so")


@cache
def printed() -> tuple[Printed, ...]:
    """The thesis's values."""
    values = yaml.safe_load(
        (catalogue.folder("reference") / "thesis_values.yaml").read_text(encoding="utf-8")
    )
    return tuple(TypeAdapter(list[Printed]).validate_python(values))


def make(hydra: Session, name: str, folder: str) -> dict[str, xr.Dataset]:
    """References of a study and of those it includes, made from their stored points.

    Parameters
    ----------
    hydra : Session
        Composes the points.
    name : str
        The study.
    folder : str
        The folder of results.

    Returns
    -------
    dict
        A combined dataset with accepted intervals for each study, by its name.

    Raises
    ------
    ConfigurationError
        If the sources are not committed, if a point is missing or was computed by sources that were not
        committed, or if a study of choices, whose effects say how wide intervals may be, lacks points.
    """
    state = provenance.provenance()["git_state"]
    if len(state) != 40:
        raise ConfigurationError([f"reference {name}: the sources are {state}: commit them first"])
    whole = results.load(name, hydra, [], folder)
    asked = {member: study_file.load(member).choices for member in study_file.members(name)}
    choices = {
        other: results.load(other, hydra, [], folder)
        for other in dict.fromkeys(itertools.chain.from_iterable(asked.values()))
    }
    complaints = [
        f"reference {name}: {row['record']} is {row['status']} {row['git_state']}".rstrip()
        for table in (whole.table, *(other.table for other in choices.values()))
        for _, row in table.drop_duplicates("record").iterrows()
        if row["status"] not in ("done", "diverged") or len(row["git_state"]) != 40
    ]
    if complaints:
        raise ConfigurationError(list(dict.fromkeys(complaints)))
    allowed = {other: tolerances(effects(stored)) for other, stored in choices.items()}
    made = {}
    for member, own in whole.table.groupby("study", sort=False):
        configs = [whole.config_at(index) for index in own.drop_duplicates("record").index]
        dataset = combine(configs, Store(folder), name)
        made[str(member)] = _with_intervals(dataset, _widest([allowed[o] for o in asked[str(member)]]))
    return made


def write(dataset: xr.Dataset, name: str) -> Path:
    """Writes the reference of a study; returns its file."""
    netcdf.write(dataset, path := _path(name), "NETCDF3_64BIT")
    return path


def _widest(several: list[dict[str, Tolerance]]) -> dict[str, Tolerance]:
    """For each metric the widest interval: methods of one study have their choices studied apart."""
    allowed: dict[str, Tolerance] = {}
    for own in several:
        for metric, tolerance_of in own.items():
            if metric not in allowed or tolerance_of.half_width > allowed[metric].half_width:
                allowed[metric] = tolerance_of
    return allowed


def _with_intervals(dataset: xr.Dataset, allowed: dict[str, Tolerance]) -> xr.Dataset:
    # Spacings stay: without them nothing can be extrapolated.
    costs = [n for n, v in dataset.items() if v.attrs.get("group") == "cost" and n != "spacing"]
    dataset = dataset.drop_vars(costs)
    for metric in metrics(dataset):
        if metric in allowed:
            dataset[metric].attrs["half_width"] = allowed[metric].half_width
            dataset[metric].attrs["half_width_reason"] = allowed[metric].reason
    return dataset
