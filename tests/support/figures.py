"""Figures as a report draws them."""

import matplotlib.style

from sphstudy.report import figure


def drawn(chosen, found):
    """A figure, a definition or module.name, drawn from results in the style of reports."""
    definition = figure.find(chosen) if isinstance(chosen, str) else chosen
    with matplotlib.style.context(figure.STYLE):
        drawing = definition.draw(found)
        if not isinstance(drawing, figure.Animation):
            drawing.canvas.draw()
    return drawing


def line(axes, label):
    """The points [2, M] of the line with this label."""
    (found,) = (one for one in axes.get_lines() if one.get_label() == label)
    return found.get_xydata().T
