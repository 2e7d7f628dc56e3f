"""The stability map of a study: its runs by case (scene, and what varies in it) and by method and h."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import pandas as pd

from sphstudy import catalogue, text
from sphstudy.analysis.dimensions import hashable
from sphstudy.analysis.results import Results
from sphstudy.analysis.stability.bounds import Bound, for_point
from sphstudy.analysis.stability.judge import Judgement, judge
from sphstudy.configuration.run_settings import RunConfig, flattened

OUTCOMES = ("failed", "timeout", "interrupted", "running", "missing", "diverged", "degraded", "done")
"""All outcomes, worst first: of two runs in one place of the map, the worse one is shown."""


@dataclass(frozen=True)
class Case:
    """A run on the map.

    row: index in the results' table. scene; settings: what varies among the runs of the scene, in words.
    variant: the method, and what its settings differ in from those usual in the scene.
    """

    row: Any
    scene: str
    settings: str
    variant: str
    h: float
    judgement: Judgement
    bounds: list[Bound]

    @property
    def label(self) -> str:
        """Scene and settings."""
        return f"{self.scene}, {self.settings}" if self.settings else self.scene


@lru_cache(maxsize=4)
def judged(results: Results) -> list[Case]:
    """Judges every run of a study and of those that it includes, each once, in order.

    Raises
    ------
    ConfigurationError
        If a file of bounds is wrong.
    """
    table = results.table.drop_duplicates("record")
    configs = {row: results.config_at(row) for row in table.index}
    flat = {row: config.flat() for row, config in configs.items()}
    found = []
    for row in table.index:
        own, scene = flat[row], flat[row]["scene"]
        of_scene = [one for one in flat.values() if one["scene"] == scene]
        of_method = [one for one in of_scene if one["method"] == own["method"]]
        bounds = for_point(scene, own)
        case = Case(
            row=row,
            scene=scene,
            settings=_words(own, _varied(of_scene, ("scene.", "n", "seed"))),
            variant=_variant(configs[row], own, of_scene, of_method),
            h=own["h"],
            judgement=judge(results.stored_at(row), bounds),
            bounds=bounds,
        )
        found.append(case)
    return found


def by_place(cases: list[Case]) -> pd.DataFrame:
    """The map: index in `cases` over label (rows) and (variant, h) (columns), -1 where there is none."""

    def worst(place: pd.Series) -> int:
        return min(place, key=lambda k: OUTCOMES.index(cases[k].judgement.outcome))

    places = pd.DataFrame(
        [{"label": c.label, "variant": c.variant, "h": c.h, "case": k} for k, c in enumerate(cases)]
    )
    grid = places.pivot_table(
        index="label", columns=["variant", "h"], values="case", aggfunc=worst, fill_value=-1, sort=False
    )
    # All variants of a method side by side, in the order in which they come.
    variants = list(dict.fromkeys(places["variant"]))
    methods = [variant.partition(",")[0] for variant in variants]
    order = {v: (methods.index(m), k) for k, (v, m) in enumerate(zip(variants, methods, strict=True))}
    return grid[sorted(grid.columns, key=lambda place: (order[place[0]], place[1]))].astype(int)


def usual(config: RunConfig) -> dict[str, Any]:
    """The default settings (flat keys) of method and solver in a scene."""
    scene, method, solver = config.scene.name, config.method.name, config.solve.name
    found = {"method": catalogue.settings("method", method), "solve": catalogue.settings("solve", solver)}
    return flattened(catalogue.merged(found, catalogue.protocol(scene, method, solver)))


def _variant(config: RunConfig, own: dict[str, Any], of_scene: list[dict], of_method: list[dict]) -> str:
    default = usual(config)
    changed = [k for k in own if k.startswith("method.") and own[k] != default.get(k, own[k])]
    solved = _varied([one for one in of_method if one["solve"] == own["solve"]], ("solve.",))
    changed += [key for key in solved if own[key] != default.get(key, own[key])]
    solver = f" {own['solve']}" if len({one["solve"] for one in of_method}) > 1 else ""
    words = _words(own, changed)
    return f"{own['method']}{solver}" + (f", {words}" if words else "")


def _varied(points: list[dict[str, Any]], keys: tuple[str, ...]) -> list[str]:
    """Keys of one of these kinds that have several values among the points."""
    chosen = [key for key in points[0] if key in keys or key.partition(".")[0] + "." in keys]
    return [key for key in chosen if len({hashable(one.get(key)) for one in points}) > 1]


def _words(flat: dict[str, Any], keys: list[str]) -> str:
    """Settings in words: "artificial stress 0.3, jaumann"."""
    return ", ".join(_word(key.rpartition(".")[2].replace("_", " "), flat[key]) for key in keys)


def _word(name: str, value: Any) -> str:
    if isinstance(value, bool):
        return name if value else f"no {name}"
    if isinstance(value, str):
        return value
    return f"{name} {text.setting(value)}"
