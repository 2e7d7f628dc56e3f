"""Dimensionless results are those of a body of any size, stiffness and density: no tolerance is absolute.

Every parameter with a unit is scaled as its dimension says, and the run is the same but for rounding.
"""

import re

import pytest

from sphstudy.configuration.composition import session
from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.running.one_run import computed
from sphstudy.store.store import Store

SCALES = {
    "E": (1e6, 1.0, 1.0),
    "rho": (1.0, 1e-6, 1.0),
    "small": (1.0, 1.0, 1e-6),
    "large": (1.0, 1.0, 1e3),
}
"""Factors of stress, density and length."""

DIMENSIONS = {
    "Pa": (1.0, 0.0, 0.0),
    "kg/m3": (0.0, 1.0, 0.0),
    "m": (0.0, 0.0, 1.0),
    "s": (-0.5, 0.5, 1.0),
    "1/s": (0.5, -0.5, -1.0),
    "rad/s": (0.5, -0.5, -1.0),
    "Pa m0.5": (1.0, 0.0, 0.5),
}
"""Powers of these factors that the units of parameters have."""

CHEAP = (
    "scene=plate n=5 h=1.3 method=tl solve=modes",
    "scene=bending n=5 h=1.5 method=tl solve=equilibrium",
    "scene=mode2 n=16 h=1.5 method=tl solve=equilibrium",
)

OTHERS = (
    "scene=plate n=5 h=1.5 method=tl scene.periods=0.5",
    "scene=plate n=5 h=1.5 method=thesis scene.periods=0.5",
    "scene=plate n=5 h=1.3 method=tl solve=limit",
    "scene=mode1 n=16 h=1.5 method=tl solve=equilibrium method.law=svk",
    "scene=tension n=5 h=1.5 method=tl",
    "scene=radial n=28 h=1.5 method=tl scene.end_time=0.5",
    "scene=spin n=8 h=1.5 method=thesis",
    # Not by the thesis's method: these rings are torn, and rounding decides where.
    "scene=rings n=5 h=1.5 method=tl",
    "scene=gray_plate_insert n=6 h=1.3 method=tl scene.periods=0.5",
    "scene=incompressible n=5 h=1.3 method=tl",
    "scene=patch n=12 h=1.5 method=tl solve=equilibrium",
    "scene=checkerboard n=12 h=1.5 method=thesis",
    "scene=sharp_wave n=5 h=1.5 method=tl",
    "scene=sharp_particle n=9 h=1.5 method=thesis",
)


def unit(field) -> str:
    found = re.search(r"\[([^\[\]]*)\]$", getattr(field.default, "description", None) or "")
    return found.group(1) if found else "1"


def scaled(config: RunConfig, factors: tuple[float, float, float]) -> RunConfig:
    """The same problem in other sizes."""

    def of_size(value: float, unit: str) -> float:
        for factor, power in zip(factors, DIMENSIONS[unit], strict=True):
            value *= factor**power
        return value

    values = config.as_dict()
    values["record"] = values["record"] | {"times": [of_size(t, "s") for t in config.record.times]}
    for part in ("scene", "method", "solve"):
        values[part] = dict(values[part])
        for name, field in type(getattr(config, part)).__dataclass_fields__.items():
            value = values[part][name]
            if unit(field) != "1" and isinstance(value, float):
                values[part][name] = of_size(value, unit(field))
    return validate(values)


def dimensionless(run) -> dict[str, float]:
    numbers = {
        name: v
        for name, v in run.data_vars.items()
        if v.ndim == 0 and v.attrs.get("group") != "cost" and v.attrs.get("units") in ("1", "degree")
    }
    return {name: float(v) for name, v in numbers.items()}


def without_numbers(message: str) -> str:
    return re.sub(r"\d[\d.e+-]*", "#", message)


@pytest.mark.parametrize(
    "case", [*CHEAP, *(pytest.param(case, marks=pytest.mark.slow) for case in OTHERS)]
)
def test_dimensionless_results_do_not_depend_on_units(case, tmp_path):
    with session() as hydra:
        point = hydra.points(case.split(), sweep=False)[0][0]
    run = computed(point.config, Store(tmp_path), point.execution)
    expected = dimensionless(run)
    assert expected
    for name, factors in SCALES.items():
        other = computed(scaled(point.config, factors), Store(tmp_path / name), point.execution)
        assert without_numbers(other.attrs["message"]) == without_numbers(run.attrs["message"]), name
        assert int(other["status"]) == int(run["status"]), name
        found = dimensionless(other)
        wrong = {
            metric: (value, found[metric])
            for metric, value in expected.items()
            if found[metric] != pytest.approx(value, rel=1e-9, abs=1e-9, nan_ok=True)
        }
        assert not wrong, name
