"""What each open choice of the thesis changes: a chart of effects for each scene."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from sphstudy.analysis.effects import CONTROL, effects
from sphstudy.analysis.results import Missing, Results
from sphstudy.report.figure import figures
from sphstudy.report.series import PERCENT

_CAPTION = (
    "each mark is the change of a metric (title, with its value in the base) when one setting is "
    "varied and all else kept; triangles point up where it grows and down where it falls, on a "
    "logarithmic axis; the numbers beside them carry the sign; what has a number only is too "
    "small for the axis, a 0 no change to the last bit. Grey: the effect of the control, a "
    "density changed in its eleventh digit; what lies in the grey may be rounding."
)

_POINTS = "percentage points"

_METRICS = {
    "plate": {
        "frequency_error": ("$\\omega$ error", "%", _POINTS, PERCENT),
        "amplitude_error": ("$A$ error", "%", _POINTS, PERCENT),
        "stress_roughness_bottom": ("roughness, bottom", "%", _POINTS, PERCENT),
    },
    "bending": {
        "end_angle_error": ("end angle error", "°", "degrees", 1.0),
        "centreline_error_max": ("centreline error", "mm", "mm", 1e3),
        "spacing_spread_bottom": ("spacing spread", "%", _POINTS, PERCENT),
    },
    "mode1": {
        "G1_error": ("$G_1$ error", "%", _POINTS, PERCENT),
        "G2_error": ("$G_2$ error", "%", _POINTS, PERCENT),
        "stress_yy_rms": ("$\\sigma_{yy}$ norm", "kPa", "kPa", 1e-3),
    },
    "mode2": {
        "G1_error": ("$G_1$ error", "%", _POINTS, PERCENT),
        "G2_error": ("$G_2$ error", "%", _POINTS, PERCENT),
        "stress_xy_rms": ("$\\sigma_{xy}$ norm", "kPa", "kPa", 1e-3),
    },
}
"""Block, metric: what it is called, its unit, the unit of its changes, and the factor to that unit."""

_SMALLEST = 1e-5
"""Smallest change on an axis, over the largest: smaller ones are rounding and would take decades."""

_WITHOUT = {"done": "undefined"}
"""What stands at a point without the metric, if not its status."""

_UP, _DOWN, _CONTROL = ("^", "#D55E00"), ("v", "#0072B2"), ("o", "0.4")


@figures(
    plate=(
        "open choices, vibrating plate",
        f"Vibrating plate, (n_y, h̃) = (15, 1.5): {_CAPTION}",
        "plate",
    ),
    bending=(
        "open choices, bending plate",
        f"Bending plate, (n_y, h̃) = (9, 1.7): {_CAPTION}",
        "bending",
    ),
    mode1=(
        "open choices, opening crack",
        f"Mode I, (n_x, h̃) = (40, 1.5): {_CAPTION}",
        "mode1",
    ),
    mode2=(
        "open choices, sliding crack",
        f"Mode II, (n_x, h̃) = (40, 1.5): {_CAPTION}",
        "mode2",
    ),
)
def _chart(results: Results, block: str) -> Figure:
    """A panel for each metric of a block, a line in it for each setting varied, the control last."""
    rows = results.select(block=block)
    rows = rows[rows["varied"] != ""]
    rows = rows.iloc[np.argsort(rows["varied"].str.startswith(CONTROL), kind="stable")]
    found = [e for e in effects(results) if e.block == block and e.metric in _METRICS[block]]
    if not found:
        raise Missing(f"{results.name}: no point of block {block} to compare with its base")
    drawing = Figure(figsize=(7.6, 1.9 + 0.26 * len(rows)), layout="constrained")
    panels = drawing.subplots(1, len(_METRICS[block]), sharey=True)
    for axes, (metric, (title, unit, change_unit, factor)) in zip(
        panels, _METRICS[block].items(), strict=True
    ):
        changes = {e.varied: factor * e.change for e in found if e.metric == metric}
        base = [factor * e.base for e in found if e.metric == metric]
        _panel(axes, rows, changes)
        axes.set_title(f"{title}\nbase: {_minus(f'{base[0]:.3g}')} {unit}" if base else title)
        axes.set_xlabel(f"|change|\n({change_unit})")
    panels[0].set_yticks(np.arange(len(rows)), [_label(varied) for varied in rows["varied"]])
    panels[0].set_ylim(len(rows) - 0.5, -0.5)
    handles = [
        Line2D([], [], linestyle="", marker=marker, color=colour, label=label)
        for (marker, colour), label in ((_UP, "grows"), (_DOWN, "falls"), (_CONTROL, "control"))
    ]
    drawing.legend(handles=handles, loc="outside upper center", ncols=3)
    return drawing


def _panel(axes: Axes, rows: pd.DataFrame, changes: dict[str, float]) -> None:
    """Changes by setting; a setting without one shows the status of its point.

    A change that is zero, or too small for the axis, stands as a number at its edge.
    """
    high = max((abs(change) for change in changes.values()), default=0.0) or 1.0
    sizes = [abs(change) for change in changes.values() if abs(change) >= _SMALLEST * high]
    # A mark on the edge would be cut in half.
    left = 10.0 ** float(np.floor(np.log10(0.6 * min(sizes, default=high))))
    right = 10.0 ** float(np.ceil(np.log10(high)))
    axes.set_xscale("log")
    # Room on the right for the number beside the largest change.
    axes.set_xlim(left, right * max((right / left) ** 0.5, 10.0))
    axes.xaxis.set_minor_formatter(NullFormatter())
    place: dict[str, Any] = {"textcoords": "offset points", "va": "center", "fontsize": 8}
    for line, (varied, status) in enumerate(zip(rows["varied"], rows["status"], strict=True)):
        change = changes.get(varied)
        if change is None or abs(change) < left:
            edge = axes.get_yaxis_transform()
            text = _number(change) if change is not None else _WITHOUT.get(status, status)
            axes.annotate(text, (0.0, line), (5, 0), xycoords=edge, color="0.4", **place)
            continue
        control = varied.startswith(CONTROL)
        marker, colour = _CONTROL if control else _UP if change > 0.0 else _DOWN
        if control:
            axes.axvspan(left, abs(change), color="0.9", zorder=0)
        axes.plot(abs(change), line, marker, color=colour)
        axes.annotate(_number(change), (abs(change), line), (6, 0), **place)


def _label(varied: str) -> str:
    """What was varied, as it is set, without the group it belongs to."""
    if varied.startswith(CONTROL):
        return "control"
    parts = (setting.partition("=") for setting in varied.split(", "))
    return ", ".join(f"{key.rpartition('.')[2]} = {_short(value)}" for key, _, value in parts)


def _number(change: float) -> str:
    return _minus(f"{change:+.2g}") if change else "0"


def _minus(number: str) -> str:
    return number.replace("-", "\N{MINUS SIGN}")


def _short(value: str) -> str:
    try:
        return f"{float(value):.4g}"
    except ValueError:
        return value
