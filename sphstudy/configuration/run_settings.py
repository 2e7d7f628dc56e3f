"""The settings of a run: one frozen dataclass, validated from a plain dictionary.

`kind` in the file of a scene or method names its module (catalogue.py), whose `Parameters` declare types,
ranges and meanings.
"""

import json
import os
import re
from functools import cache, cached_property
from typing import Any

from sphstudy.catalogue import method_module, scene_module, solver_module
from sphstudy.errors import ConfigurationError
from sphstudy.parameters import adapter, checked, count, described, number, parameters


@parameters
class Record:
    """What a run keeps."""

    samples: int = count("points of the history, at equal intervals", ge=10, le=100_000)
    times: tuple[float, ...] = described("times at which fields are kept (s), besides each stage's end")
    frames: int = count("evenly spaced times at which fields are kept too", ge=0, le=1000)


@parameters
class RunConfig:
    """What determines the numbers of a run; scene, method, solver are Parameters of their modules."""

    scene: Any = described("what is simulated")
    method: Any = described("how it is discretised")
    solve: Any = described("what is done with it")
    h: float = number("relative smoothing radius h̃ = h / ((Δx + Δy)/2)", gt=0)
    n: int = count("resolution: rows of a plate, particles along the side of a crack square", ge=1)
    seed: int = count("seed of anything random in a scene", ge=0, le=2**63 - 1)
    record: Record = described("what is kept")

    def as_dict(self) -> dict[str, Any]:
        """The configuration as nested plain dictionaries, as it is stored and hashed."""
        return {key: dict(v) if isinstance(v, dict) else v for key, v in self._plain.items()}

    @cached_property
    def text(self) -> str:
        """The configuration as JSON: the same text for the same run."""
        return json.dumps(self._plain, sort_keys=True)

    def flat(self) -> dict[str, Any]:
        """The configuration as `flattened` has it."""
        return flattened(self._plain)

    @cached_property
    def _plain(self) -> dict[str, Any]:
        return adapter(RunConfig).dump_python(self, mode="json", warnings=False) | {
            part: _adapter_of(getattr(self, part)).dump_python(getattr(self, part), mode="json")
            for part in ("scene", "method", "solve")
        }

    @property
    def label(self) -> str:
        """A name for people: scene, method, h and n."""
        return f"{self.scene.name}-{self.method.name}-h{self.h:g}-n{self.n}"


def flattened(nested: dict[str, Any]) -> dict[str, Any]:
    """A configuration with dotted keys, in which `scene`, `method` and `solve` stand for their names.

    Parameters
    ----------
    nested : dict
        The configuration as `RunConfig.as_dict` returns it.
    """
    flat: dict[str, Any] = {}
    for key, value in nested.items():
        if isinstance(value, dict):
            flat |= {f"{key}.{inner}": v for inner, v in value.items() if inner != "name"}
            flat |= {key: value["name"]} if "name" in value else {}
        else:
            flat[key] = value
    return flat


def _adapter_of(value: Any) -> Any:
    cls: Any = type(value)
    return adapter(cls)


def validate(composed: dict[str, Any]) -> RunConfig:
    """The configuration of a run from plain dictionaries.

    Parameters
    ----------
    composed : dict
        As Hydra composes it, or as `RunConfig.as_dict` returns it.

    Raises
    ------
    ConfigurationError
        With every complaint about types, ranges and unknown keys; if there are none, with every complaint
        about the fit of scene, method, solver and resolution, and about memory.
    """
    complaints: list[str] = []
    try:
        modules = {
            "scene": scene_module(composed["scene"]["kind"]),
            "method": method_module(composed["method"]["kind"]),
            "solve": solver_module(composed["solve"]["name"]),
        }
        names = [composed[part]["name"] for part in modules]
        rest = {key: composed[key] for key in ("h", "n", "seed", "record")}
    except (KeyError, TypeError) as error:
        raise ConfigurationError([f"not the configuration of a run ({error})"]) from None
    # Files are called after them.
    complaints += [
        f"name={name}: should be up to 40 letters, digits and _ + - only"
        for name in names
        if not (isinstance(name, str) and re.fullmatch(r"[\w+-]{1,40}", name))
    ]
    parts = {
        part: checked(module.Parameters, composed[part], f"{part}.", complaints)
        for part, module in modules.items()
    }
    config = checked(RunConfig, {**parts, **rest}, "", complaints)
    if complaints:
        raise ConfigurationError(complaints)
    complaints += modules["scene"].check(config)
    complaints += modules["method"].check(config)
    if config.solve.name not in modules["method"].SOLVERS:
        offered = ", ".join(modules["method"].SOLVERS)
        complaints.append(f"solve={config.solve.name}: method {config.method.name} takes {offered}")
    particles = modules["scene"].particles(config)
    if (needed := modules["method"].memory(particles, config)) > (there := _memory_of_machine()):
        complaints.append(
            f"n={config.n}: {particles:,} particles need about {_size(needed)} of memory, "
            f"this machine has {_size(there)}"
        )
    if complaints:
        raise ConfigurationError(complaints)
    return config


@cache
def _memory_of_machine() -> int:
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def _size(count_of_bytes: float) -> str:
    for unit in ("bytes", "KiB", "MiB", "GiB", "TiB"):
        if count_of_bytes < 1024:
            return f"{count_of_bytes:.0f} {unit}"
        count_of_bytes /= 1024
    return f"{count_of_bytes:,.0f} PiB"
