"""Records from before the numerics had a version number, moved to the names that they have today.

Their numerics version is a digest of the code that computed them. `adoption.toml` lists the digests of
the last code before number 1, whose results number 1 repeats to the last bit; and for each digest of its
metrics, the version that the same metrics have now.
"""

import json
import os
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.errors import ConfigurationError
from sphstudy.store import identity
from sphstudy.store.lock import is_alive
from sphstudy.store.store import Store, read, read_summary

_KINDS = {"incompressible": "plate", "swinging_plate": "plate"}
"""Kinds of scenes that have been merged into another, which has the same settings."""


@dataclass(frozen=True)
class Adoption:
    """Names of the records that were adopted, and of those that were left with the reason."""

    adopted: list[str]
    left: dict[str, str]


def adoptable(attributes: dict[str, Any]) -> bool:
    """Whether a record with these global attributes is one whose numbers are those of number 1."""
    return attributes["numerics_version"] in _known()["numerics"]


def adopt(store: Store) -> Adoption:
    """Moves every record of before whose numbers are known to be today's; leaves all others alone.

    A move writes the record under its new name, then removes the old one: killed at any moment and begun
    again, it loses nothing. A record that has the new name already is not overwritten.

    Parameters
    ----------
    store : Store
        The records.

    Raises
    ------
    OSError
        If the disk does not take a record.
    """
    result = Adoption([], {})
    for path in store.files():
        summary = read_summary(path)
        # Today's versions begin with a number, and are shorter or longer than the digests of before.
        if summary is None or len(summary.attributes["numerics_version"]) != 12:
            continue
        if reason := _adopt(path, summary.attributes, store):
            result.left[path.name] = reason
        else:
            result.adopted.append(path.name)
    return result


def _adopt(path: Path, attributes: dict[str, Any], store: Store) -> str:
    """Moves one record; returns why it stays where it is, "" if it does not."""
    if not adoptable(attributes):
        return "computed by code of another version"
    try:
        config = validate(translated(json.loads(attributes["configuration"])))
    except ConfigurationError as error:
        return f"its configuration is not valid any more: {error.complaints[0]}"
    except (KeyError, TypeError) as error:
        return f"its configuration is not valid any more ({error!r})"
    if (now := identity.numerics_version(config)) != str(_known()["number"]):
        return f"the numerics have changed since: today's version is {now}"
    new = store.record_path(config)
    if is_alive(store.claim_path(config)):
        return f"{new.name} is being computed now"
    if (there := read_summary(new)) is None:
        if (run := read(path)) is None:
            return "it is damaged"
        run.attrs |= _attributes(config, run.attrs)
        store.keep(config, run)
    elif there.attributes["date_created"] != attributes["date_created"]:
        return f"there is {new.name} already"
    if (log := path.with_suffix(".log")).exists() and not store.log_path(config).exists():
        os.replace(log, store.log_path(config))
    path.unlink()
    return ""


def translated(configuration: dict[str, Any]) -> dict[str, Any]:
    """A configuration of before in the words of today: damping and smearing belong to the method."""
    scene, method, solve = (dict(configuration[part]) for part in ("scene", "method", "solve"))
    scene["kind"] = _KINDS.get(scene["kind"], scene["kind"])
    method["damping"] = solve.pop("damping", 0.0)
    smoothing = solve.pop("smoothing", 0.0)
    # The total Lagrangian method has no smeared velocity: 0 was all that it took.
    if method["kind"] == "updated_lagrangian":
        method["smoothing"] = smoothing
    return configuration | {"scene": scene, "method": method, "solve": solve}


def _attributes(config: RunConfig, before: dict[str, Any]) -> dict[str, str]:
    """The attributes that change. Unknown metrics keep their version, and are measured when read."""
    metrics = before.get("metrics_version", "")
    return {
        "configuration": config.text,
        "key": identity.key(config),
        "numerics_version": identity.numerics_version(config),
        **({"metrics_version": _known()["metrics"].get(metrics, metrics)} if metrics else {}),
    }


@cache
def _known() -> dict[str, Any]:
    found = tomllib.loads(Path(__file__).with_name("adoption.toml").read_text(encoding="utf-8"))
    return found | {"numerics": frozenset(found["numerics"].split())}
