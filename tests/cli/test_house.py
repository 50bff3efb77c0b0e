"""The drawing of the house matches the sources, in which no folder includes one above it."""

import pathlib
import subprocess
import sys

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/draw_house.py"


def check(*arguments):
    return subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True)


def test_the_picture_is_that_of_the_sources():
    result = check("--check")
    assert result.returncode == 0, result.stderr


def test_another_picture_is_noticed(tmp_path):
    copy = tmp_path / "scripts/draw_house.py"
    copy.parent.mkdir()
    copy.write_text(SCRIPT.read_text())
    for folder in ("core", "mesh"):
        (tmp_path / "src/sinew" / folder).mkdir(parents=True)
    (tmp_path / "docs/images").mkdir(parents=True)
    mesh = tmp_path / "src/sinew/mesh/mesh.hpp"
    mesh.write_text('#include "sinew/core/types.hpp"\n')
    subprocess.run([sys.executable, copy], check=True)
    assert subprocess.run([sys.executable, copy, "--check"]).returncode == 0
    (tmp_path / "src/sinew/core/types.hpp").write_text('#include "sinew/mesh/mesh.hpp"\n')
    circle = subprocess.run([sys.executable, copy, "--check"], capture_output=True, text=True)
    assert circle.returncode != 0 and "circle" in circle.stderr
