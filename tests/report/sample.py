"""A study with a point of every outcome, made up without running anything, and a reader of its page."""

import sys
from html.parser import HTMLParser
from types import ModuleType

from matplotlib.figure import Figure

from sphstudy.analysis.claims import claim
from sphstudy.analysis.claims.claim import NOT, Finding
from sphstudy.analysis.results import Missing
from sphstudy.report import page
from sphstudy.report.figure import FigureDefinition
from tests.support import results
from tests.support.records import record

STUDY = """
title: A sample of <everything> that may happen
blocks:
  grid: {scene: plate, h: [1.3, 1.5], n: [9, 15, 21]}
  options:
    scene: plate
    h: 1.5
    n: 9
    vary: {scene.rho: 7750.0000001, method.artificial_stress: 0.3}
figures: [made_up.good, made_up.unwritable, made_up.broken, made_up.lacking, made_up.unheard_of]
claims: [T1]
"""
MESSAGE = "ValueError: <script>alert('n & m')</script>"
OUTCOMES = {  # (h, n): status, message, frequency error, CPU seconds
    (1.3, 9): ("done", "", -0.0304, 2.25),
    (1.5, 9): ("done", "", -0.11987, 3.5),
    (1.5, 15): ("done", "", 1.25e-7, 16.0),
    (1.3, 15): ("diverged", "speed 3e9 at step 17", None, 1.0),
    (1.3, 21): ("failed", MESSAGE, None, None),
}
ARTIFICIAL = -0.14


def _good(results):
    drawn = Figure()
    drawn.add_subplot().plot([0, 1], [0, 1])
    return drawn


def _unwritable(results):
    drawn = Figure()
    drawn.suptitle(r"$\unheard{}$")
    return drawn


def _broken(results):
    raise ZeroDivisionError("<b>by nothing</b>")


def _lacking(results):
    raise Missing("no point with n=99")


def _record(point, config):
    """The record of a point, None for one that is not in the store."""
    outcome = OUTCOMES.get((point["h"], point["n"]))
    if outcome is None or "rho" in point["varied"]:
        return None
    status, message, error, seconds = outcome
    error = ARTIFICIAL if point["varied"] else error
    metrics = {} if error is None else {"frequency_error": error}
    cost = (
        {} if seconds is None else {"cpu_seconds": (seconds, "s"), "particles": (12 * config.n**2, "1")}
    )
    return record(config, status, message, metrics, cost)


def load(folder, monkeypatch, hydra, stored=True):
    """Results of the study in an empty folder; with `stored`, most of its points are in the store."""
    drawn = ModuleType("made_up")
    for draw in (_good, _unwritable, _broken, _lacking):
        name = draw.__name__.removeprefix("_")
        setattr(drawn, name, FigureDefinition(f"made_up.{name}", "9.1", f"A {name} figure.", draw))
    monkeypatch.setitem(sys.modules, "sphstudy.report.figures.made_up", drawn)
    rule = claim.claim("T1", "All is well.", "page 1", reproduced="yes", partly="half", otherwise="no")
    monkeypatch.setattr(
        claim, "every_claim", lambda: {"T1": rule(lambda results: Finding(NOT, "1 of 2", "a bug"))}
    )
    make = _record if stored else lambda point, config: None
    return results.stored(folder, monkeypatch, hydra, STUDY, make, "sample")


def write_page(found, folder):
    """The text of the page written for these results."""
    return page.write(found, folder).read_text(encoding="utf-8")


class Reader(HTMLParser):
    """A page as read: text, tables (caption: headings and rows of (text, order)), ids, links, sources."""

    def __init__(self, text):
        super().__init__()
        self.text, self.ids, self.links, self.sources, self.images = "", [], [], [], []
        self.tables, self.tags = {}, []
        self._rows, self._caption, self._place = [], "", None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append(tag)
        self.ids += [attributes["id"]] if "id" in attributes else []
        self.links += [attributes["href"]] if "href" in attributes else []
        self.sources += [attributes["src"]] if "src" in attributes else []
        if tag == "img":
            self.images.append(attributes)
        elif tag == "table":
            self._rows, self._caption = [], ""
        elif tag == "tr":
            self._rows.append([])
        elif tag in ("td", "th"):
            self._rows[-1].append(("", attributes.get("data-order")))
        if tag in ("td", "th", "caption", "script", "style"):
            self._place = tag

    def handle_endtag(self, tag):
        self.text += " " if tag in ("td", "th", "dt", "dd", "li") else ""
        if tag == "table":
            self.tables[self._caption] = ([text for text, _ in self._rows[0]], self._rows[1:])
        if tag in ("td", "th", "caption", "script", "style"):
            self._place = None

    def handle_data(self, data):
        if self._place in ("script", "style"):
            return
        self.text += data
        if self._place == "caption":
            self._caption += data
        elif self._place:
            text, order = self._rows[-1][-1]
            self._rows[-1][-1] = (text + data.strip(), order)
