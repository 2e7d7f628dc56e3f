"""Named studies: a YAML file in `studies/`, the only thing that a new study needs.

    title: what it is
    blocks:                     # named grids of settings; a list is swept
      grid: {scene: mode1, method: thesis, h: [1.3, 1.5], n: [40, 50, 60]}
      options:                  # `vary`: each of these on its own, everything else as in the block
        {scene: mode1, h: 1.5, n: 40, vary: {scene.frame_layers: [1, 4], method.visibility: exclusive}}
    include: [plate]            # studies that belong to this one: run, compared and shown with it
    shows: [choices]            # studies shown with it as far as their points are stored, never run by it
    figures: [crack.release_rates]     # module.function of report/figures
    claims: [C1, C2]            # of analysis/claims
    choices: [choices]          # studies of open choices that say how wide intervals of a reference are
    unstable:                   # cells whose numbers nothing may be judged by
      - {where: {h: 1.3, n: [15, 21]}, reason: why}
    judged: true                # runs are judged by bounds of scenes: the page has a stability map
    skip_invalid: true          # leave out cells that are not valid instead of refusing the study
    forbid_diverged: true       # a diverged point makes the exit status 1

All but the title are optional. To give a setting that is itself a list, write it as a string: "[1.5, 3]".
"""

import itertools
import re
from typing import Any

import yaml
from pydantic import TypeAdapter, ValidationError

from sphstudy import catalogue
from sphstudy.configuration.execution import SETTINGS
from sphstudy.errors import ConfigurationError, unknown
from sphstudy.parameters import described, parameters
from sphstudy.text import short_name

Setting = int | float | str | bool | None
Values = Setting | list[Setting]


def holds(where: dict[str, Values], flat: dict[str, Any]) -> bool:
    """Whether a run has certain settings.

    Parameters
    ----------
    where : dict
        Settings by dotted key; a list stands for any of its values.
    flat : dict
        The configuration of the run, with dotted keys.
    """
    return all(
        flat.get(key) in (value if isinstance(value, list) else [value]) for key, value in where.items()
    )


@parameters
class Unstable:
    """Cells in an instability, where rounding alone changes the numbers."""

    where: dict[str, Values] = described("settings of the cells; a list: any of these")
    reason: str = described("why nothing is judged there")

    def holds(self, flat: dict[str, Any]) -> bool:
        """Whether a run with this configuration (dotted keys) is one of the cells."""
        return holds(self.where, flat)


@parameters
class Study:
    """What a study file holds."""

    title: str = described("what it is")
    blocks: dict[str, dict[str, Values | dict[str, Values]]] = described("named grids of settings")
    include: list[str] = described("studies that belong to this one")
    shows: list[str] = described("studies shown with this one, as far as they are stored")
    figures: list[str] = described("figures, module.function")
    claims: list[str] = described("claims checked, by id")
    choices: list[str] = described("studies of open choices, for the intervals of its reference")
    unstable: list[Unstable] = described("cells that sit in an instability")
    judged: bool = described("whether its runs are judged by bounds, with a stability map on the page")
    skip_invalid: bool = described("leave out cells that are not valid")
    forbid_diverged: bool = described("whether a diverged point counts as failed")


_OPTIONAL: dict[str, Any] = {
    "blocks": {},
    "include": [],
    "shows": [],
    "figures": [],
    "claims": [],
    "choices": ["choices"],
    "unstable": [],
    "judged": False,
    "skip_invalid": False,
    "forbid_diverged": False,
}


def names() -> list[str]:
    """Names of all studies."""
    return sorted(path.stem for path in catalogue.folder("studies").glob("*.yaml"))


def results_name(name: str, overrides: list[str]) -> str:
    """The name of a study's dataset and of its report.

    Parameters
    ----------
    name : str
        The study.
    overrides : list of str
        What replaces settings of its file; those that make other runs become part of the name.
    """
    changed = [o for o in overrides if o.partition("=")[0] not in SETTINGS]
    return short_name(re.sub(r"[^\w.+=-]+", "_", "-".join([name, *changed])))


def load(name: str) -> Study:
    """The study of that name. Raises ConfigurationError if there is none or its file is wrong."""
    if name not in names():
        hint = "; `sphstudy speed` measures this machine" if name == "speed" else ""
        raise ConfigurationError([unknown("study", name, names()) + hint])
    path = catalogue.folder("studies") / f"{name}.yaml"
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
        if not isinstance(values, dict) or not all(isinstance(key, str) for key in values):
            raise TypeError("should be settings by name: title, blocks, …")
        return TypeAdapter(Study).validate_python({**_OPTIONAL, **values})
    except RecursionError:
        raise ConfigurationError([f"{path.name}: nested too deeply"]) from None
    except (OSError, UnicodeDecodeError, yaml.YAMLError, TypeError) as error:
        raise ConfigurationError([f"{path.name}: {' '.join(str(error).split())}"]) from None
    except ValidationError as error:
        raise ConfigurationError(
            [f"{path.name}: {'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors()]
        ) from None


def members(name: str, above: tuple[str, ...] = ()) -> list[str]:
    """The study and all that it includes, itself last.

    Parameters
    ----------
    name : str
        The study.
    above : tuple of str
        Studies that include it; among them it would include itself.

    Raises
    ------
    ConfigurationError
        If a study includes itself, does not exist, or has a wrong file.
    """
    if name in above:
        raise ConfigurationError([f"study {name}: includes itself ({' > '.join((*above, name))})"])
    inner = [member for part in load(name).include for member in members(part, (*above, name))]
    return list(dict.fromkeys([*inner, name]))


def grids(study: Study, overrides: list[str]) -> dict[str, list[list[str]]]:
    """The sweeps that make the points of a study.

    Parameters
    ----------
    study : Study
        The study.
    overrides : list of str
        What replaces settings of its blocks.

    Returns
    -------
    dict
        For every block its sweeps, each a list of overrides. Of a block with `vary`, the first point is
        the one in which nothing is varied.

    Raises
    ------
    ConfigurationError
        If an override is given twice, or `vary` is no mapping.
    """
    given = dict(override.partition("=")[::2] for override in overrides)
    if len(given) < len(overrides):
        keys = [override.partition("=")[0] for override in overrides]
        twice = [key for key in given if keys.count(key) > 1]
        raise ConfigurationError([f"{key}: is given twice" for key in twice])
    found = {}
    for block, settings in study.blocks.items():
        vary = settings.get("vary", {})
        if not isinstance(vary, dict):
            raise ConfigurationError([f"block {block}: vary takes settings, not {vary}"])
        base = {key: _text(value) for key, value in settings.items() if key != "vary"} | given
        changes: list[dict[str, str]] = [{}] if not vary else _one_at_a_time(vary)
        found[block] = [[f"{k}={v}" for k, v in {**base, **change}.items()] for change in changes]
    return found


def _one_at_a_time(vary: dict[str, Values]) -> list[dict[str, str]]:
    """Nothing changed, then each setting alone with each of its values."""
    lists = ((key, value if isinstance(value, list) else [value]) for key, value in vary.items())
    single = itertools.chain.from_iterable(
        [{key: _text(value)} for value in values] for key, values in lists
    )
    return [{}, *single]


def _text(value: Any) -> str:
    if isinstance(value, list):
        return ",".join(_text(item) for item in value)
    return "null" if value is None else str(value)
