"""The page in a browser: nothing runs over the edge of a phone, headings sort, and it prints.

Where no Chromium is installed, only what can be read off the page itself is checked.
"""

import json
import re
import shutil
import subprocess

import pytest

from sphstudy.configuration.composition import session
from tests.report import sample

pytestmark = pytest.mark.slow

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
OPTIONS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
)  # fmt: skip
WIDTHS = (375, 800, 1280)

# The page stands in a frame of the width wanted and tells the page around it what it looks like.
FRAME = """<iframe src="probed.html" style="width:{width}px;height:900px;border:0"></iframe>
<pre id="told"></pre>
<script>
addEventListener("message", (event) => document.getElementById("told").textContent = event.data);
</script>"""
PROBE = """<script>
const order = (table, column) => [...table.tBodies[0].rows].map((row) => row.cells[column].textContent);
addEventListener("load", () => {
  const told = { width: innerWidth, scrolled: document.scrollingElement.scrollWidth };
  const table = [...document.querySelectorAll("table.sortable")].find(
    (each) => each.caption.textContent === "Points of block grid, scene plate");
  const heading = table.tHead.rows[0].cells[3], button = heading.querySelector("button");
  told.before = order(table, 3);
  button.click(); told.rising = order(table, 3); told.sort = [heading.ariaSort];
  button.click(); told.falling = order(table, 3); told.sort.push(heading.ariaSort);
  told.images = [...document.images].map((image) => image.naturalWidth > 0);
  told.beside = getComputedStyle(document.querySelector("nav")).position;
  parent.postMessage(JSON.stringify(told), "*");
});
</script>"""


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    with session() as hydra, pytest.MonkeyPatch.context() as patch:
        found = sample.load(folder, patch, hydra)
        sample.write_page(found, folder)
    return folder / "index.html"


def browse(profile, *arguments):
    command = [BROWSER, *OPTIONS, f"--user-data-dir={profile}", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    return done.stdout


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_runs_over_the_edge_and_headings_sort(written, tmp_path, width):
    page = written.read_text(encoding="utf-8")
    assert '<meta name="viewport" content="width=device-width, initial-scale=1">' in page
    # Every table but that of claims, which is stacked on a phone, stands in a box that scrolls.
    boxed = len(re.findall(r'<div class="scroll"[^>]*>\s*<table', page))
    assert boxed == page.count("<table") - page.count('<table class="claims"')
    if BROWSER is None:
        return
    (tmp_path / "probed.html").write_text(page.replace("</body>", f"{PROBE}</body>"), encoding="utf-8")
    (tmp_path / "frame.html").write_text(FRAME.format(width=width))
    address = (tmp_path / "frame.html").as_uri()
    shown = browse(tmp_path / "profile", "--virtual-time-budget=5000", "--dump-dom", address)
    told = json.loads(re.search(r'<pre id="told">(.*?)</pre>', shown, re.S)[1])
    assert told["width"] == width
    assert told["scrolled"] <= width
    assert told["images"] == [True]
    assert told["beside"] == ("sticky" if width > 1120 else "static")
    assert told["before"] == ["−3.04", "–", "–", "−12.0", "1.25×10⁻⁵", "–"]
    assert told["rising"] == ["−12.0", "−3.04", "1.25×10⁻⁵", "–", "–", "–"]
    assert told["falling"] == ["1.25×10⁻⁵", "−3.04", "−12.0", "–", "–", "–"]
    assert told["sort"] == ["ascending", "descending"]


def test_it_prints(written, tmp_path):
    assert "@media print" in written.read_text(encoding="utf-8")
    if BROWSER is None:
        return
    printed = tmp_path / "page.pdf"
    browse(tmp_path / "profile", f"--print-to-pdf={printed}", written.as_uri())
    assert printed.read_bytes().startswith(b"%PDF")
    assert b"/Subtype /Image" in printed.read_bytes()
