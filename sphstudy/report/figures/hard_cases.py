"""Particle pictures of hard cases, method beside method: of each scene, `hard_cases.<function>.<scene>`.

Shown are those runs of the scene that keep frames (record.frames), case by case.
"""

from matplotlib.figure import Figure

from sphstudy.analysis.results import Missing, Results
from sphstudy.analysis.stability.cases import judged
from sphstudy.report.figure import Animation, family
from sphstudy.report.panels import Panels, Quantity, Shown, mises, pressure

_FRAMES = 40
"""An animation has no more of them."""

_MOST = 9
"""Panels of a figure at most: more cannot be read."""

_SHARED = "the same colours and the same view in all panels, those of the sound runs."


@family(
    "particles: {}",
    "Scene {}: particles where they are at the end of the run, or when all was well for the last time, "
    f"coloured by von Mises stress; {_SHARED}",
)
def stress(results: Results, scene: str) -> Figure:
    return _at_the_end(_panels(results, scene, mises, "von Mises stress"))


@family(
    "pressure: {}",
    "Scene {}: particles where they are at the end of the run, or when all was well for the last time, "
    f"coloured by pressure; {_SHARED}",
)
def pressures(results: Results, scene: str) -> Figure:
    return _at_the_end(_panels(results, scene, pressure, "pressure", symmetric=True))


@family(
    "motion: {}",
    "Scene {} from begin to end: particles coloured by von Mises stress; a diverging run stops where "
    f"all was well for the last time; {_SHARED}",
)
def motion(results: Results, scene: str) -> Animation:
    return _moving(_panels(results, scene, mises, "von Mises stress"))


@family(
    "motion with pressure: {}",
    "Scene {} from begin to end: particles coloured by pressure; a diverging run stops where all was "
    f"well for the last time; {_SHARED}",
)
def pressure_motion(results: Results, scene: str) -> Animation:
    return _moving(_panels(results, scene, pressure, "pressure", symmetric=True))


def _panels(
    results: Results, scene: str, quantity: Quantity, title: str, symmetric: bool = False
) -> Panels:
    """Raises Missing if no run of the scene that keeps frames is stored."""
    shown = []
    cases = [case for case in judged(results) if case.scene == scene]
    cases = [case for case in cases if results.config_at(case.row).record.frames > 1]
    # Methods beside each other, case by case.
    settings = list(dict.fromkeys(case.settings for case in cases))
    cases.sort(key=lambda case: settings.index(case.settings))
    for case in cases:
        run = results.stored_at(case.row)
        if run is not None and run.sizes.get("snapshot"):
            words = [case.settings] if len(settings) > 1 else []
            label = ", ".join([*words, case.variant, f"h\N{NO-BREAK SPACE}{case.h:g}"])
            shown.append(Shown(run, case.settings, label, case.judgement.outcome))
    if not shown:
        raise Missing(f"{results.name}: no run of scene {scene} with record.frames is stored")
    if len(shown) > _MOST:
        raise ValueError(f"{len(shown)} runs of scene {scene} keep frames, which at most {_MOST} should")
    return Panels(shown, quantity, title, symmetric)


def _at_the_end(panels: Panels) -> Figure:
    panels.show(panels.end)
    return panels.figure


def _moving(panels: Panels) -> Animation:
    frames = min(_FRAMES, panels.frames)
    last = max(1, frames - 1)
    return Animation(panels.figure, lambda k: panels.show(panels.end * k / last), frames)
