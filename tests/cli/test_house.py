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


def small_house(root, modules):
    """A copy of the script in a project of the folders core, mesh and fem, where mesh includes core, and fem mesh."""
    copy = root / "scripts/draw_house.py"
    copy.parent.mkdir()
    copy.write_text(SCRIPT.read_text())
    for folder, below in (("core", None), ("mesh", "core"), ("fem", "mesh")):
        (root / "src/sinew" / folder).mkdir(parents=True)
        if below:
            (root / "src/sinew" / folder / "all.hpp").write_text(f'#include "sinew/{below}/types.hpp"\n')
    (root / "src/sinew/CMakeLists.txt").write_text(modules)
    (root / "docs/images").mkdir(parents=True)
    return copy


def test_another_picture_is_noticed(tmp_path):
    copy = small_house(tmp_path, "sinew_module(core)\nsinew_module(mesh DEPENDS core)\nsinew_module(fem DEPENDS mesh)\n")
    subprocess.run([sys.executable, copy], check=True)
    assert subprocess.run([sys.executable, copy, "--check"]).returncode == 0
    (tmp_path / "src/sinew/core/types.hpp").write_text('#include "sinew/mesh/mesh.hpp"\n')
    circle = subprocess.run([sys.executable, copy, "--check"], capture_output=True, text=True)
    assert circle.returncode != 0 and "circle" in circle.stderr


def test_an_include_that_a_depends_line_does_not_allow_is_noticed(tmp_path):
    copy = small_house(tmp_path, "sinew_module(core)\nsinew_module(mesh LEVEL 2 DEPENDS core\n  PRIVATE_LIBRARIES ZLIB::ZLIB)\n"
                                 "sinew_module(fem DEPENDS mesh)\n")
    subprocess.run([sys.executable, copy], check=True)
    above = tmp_path / "src/sinew/fem/all.hpp"
    above.write_text(above.read_text() + '#include "sinew/core/types.hpp"\n')  # through mesh
    subprocess.run([sys.executable, copy], check=True)
    (tmp_path / "src/sinew/CMakeLists.txt").write_text(
        "sinew_module(core)\nsinew_module(mesh DEPENDS core)\nsinew_module(fem DEPENDS core)\n")
    refused = subprocess.run([sys.executable, copy], capture_output=True, text=True)
    assert refused.returncode != 0 and "src/sinew/fem includes headers of mesh" in refused.stderr
