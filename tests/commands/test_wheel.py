"""The installed program brings its configuration and studies, and runs from any folder."""

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
ROOT = Path(__file__).parent.parent.parent


def test_the_wheel_runs_elsewhere(tmp_path):
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    built, site = tmp_path / "wheel", tmp_path / "site"
    build = [*pip, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", built, ROOT]
    subprocess.run(build, check=True, timeout=120)
    (wheel,) = built.glob("*.whl")
    subprocess.run([*pip, "install", "--no-deps", "--target", site, wheel], check=True, timeout=120)
    script = (
        f"import sys; sys.path.insert(0, {str(site)!r}); import sphstudy; print(sphstudy.__file__);"
        "from sphstudy.__main__ import main;"
        "sys.exit(main(['scene=plate', 'n=5', 'scene.periods=0.1']) or main(['list'])"
        " or main(['report', 'plate']) or main(['compare', 'plate', 'printed']) - 1)"
    )
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    result = subprocess.run(
        [sys.executable, "-c", script], cwd=elsewhere, capture_output=True, text=True, timeout=300
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.startswith(str(site))
    assert "thesis" in result.stdout
    assert "axis of figure 4.2a" in result.stdout
    assert (elsewhere / "results" / "reports" / "plate" / "index.html").is_file()
    assert len(list((elsewhere / "results" / "runs").glob("*.nc"))) == 1
