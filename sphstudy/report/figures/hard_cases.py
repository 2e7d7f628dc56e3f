"""Particle pictures of hard cases, method beside method: of each scene, `hard_cases.<function>.<scene>`.

They show the runs of the scene that keep frames (record.frames), case by case.
"""

from matplotlib.figure import Figure

from sphstudy.analysis.results import Missing, Results
from sphstudy.analysis.stability.cases import judged
from sphstudy.report.figure import Animation, figures
from sphstudy.report.panels import Panels, Quantity, Shown, mises, pressure

_FRAMES = 40
"""Frames of an animation at most."""

_MOST = 9
"""Panels of a figure at most: more cannot be read."""

_SHARED = "the same colours and the same view in all panels, those of the sound runs."
_AT_THE_END = (
    "Scene {}: particles where they are at the end of the run, or when all was well for the last time, "
    "coloured by"
)
_MOVING = "Scene {} from begin to end: particles coloured by"
_UNTIL = f"a diverging run stops where all was well for the last time; {_SHARED}"


@figures(
    stress=("particles: {}", f"{_AT_THE_END} von Mises stress; {_SHARED}", mises, "von Mises stress"),
    pressures=("pressure: {}", f"{_AT_THE_END} pressure; {_SHARED}", pressure, "pressure"),
)
def _still(results: Results, quantity: Quantity, title: str, scene: str) -> Figure:
    panels = _panels(results, quantity, title, scene)
    panels.show(panels.end)
    return panels.figure


@figures(
    motion=("motion: {}", f"{_MOVING} von Mises stress; {_UNTIL}", mises, "von Mises stress"),
    pressure_motion=("motion with pressure: {}", f"{_MOVING} pressure; {_UNTIL}", pressure, "pressure"),
)
def _moving(results: Results, quantity: Quantity, title: str, scene: str) -> Animation:
    panels = _panels(results, quantity, title, scene)
    frames = min(_FRAMES, panels.frames)
    last = max(1, frames - 1)
    return Animation(panels.figure, lambda k: panels.show(panels.end * k / last), frames)


def _panels(results: Results, quantity: Quantity, title: str, scene: str) -> Panels:
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
        raise ValueError(
            f"{len(shown)} runs of scene {scene} keep frames; a figure shows {_MOST} at most"
        )
    return Panels(shown, quantity, title, symmetric=quantity is pressure)
