"""The tutorials run as printed, and their output is the one that they show."""

import os
import re
import shutil
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest
import sinew

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = ROOT / "docs" / "tutorials"
BLOCK = re.compile(r"```(\w+)\n(.*?)```", re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")
FIRST = "bending_finger"  # makes the mesh and the scene that the others use

pytestmark = pytest.mark.skipif(shutil.which("gmsh") is None, reason="Gmsh is not installed")


def environment():
    """Environment as in docs/install.md."""
    folder = Path(sinew.__file__).parents[2] / "bin"
    return {
        **os.environ,
        "SINEW": str(ROOT),
        "PATH": os.pathsep.join([str(folder), str(Path(sys.executable).parent), os.environ["PATH"]]),
        "PYTHONPATH": os.pathsep.join(sys.path),
        "MPLBACKEND": "Agg",
    }


def shell(commands, folder):
    """Standard output of commands, which must succeed."""
    result = subprocess.run(
        ["bash", "-e", "-c", commands],
        cwd=folder, env=environment(), capture_output=True, text=True, timeout=300, check=False,
    )
    assert result.returncode == 0, f"{commands}\n{result.stdout}{result.stderr}"
    return result.stdout


def view(command, folder):
    """Starts the view, fetches its page and ends it as Ctrl-C does."""
    started = subprocess.Popen(
        [*command.split(), "--no-open", "--port", "0"],
        cwd=folder, env=environment(), stdout=subprocess.PIPE, text=True,
    )
    try:
        address = next(found.group() for line in started.stdout if (found := re.search(r"http://[\d.]+:\d+/", line)))
        with urllib.request.urlopen(address, timeout=60) as page:
            assert page.status == 200 and page.read()
    finally:
        started.send_signal(signal.SIGINT)
    assert started.wait(timeout=60) == 0


def assert_shows(output, shown):
    """Every line shown is a line of the output, in this order. Numbers may differ by 5 % or 5e-4, since Gmsh's meshes differ."""
    lines = iter(output.splitlines())
    for line in shown.splitlines():
        if line != "...":
            assert any(agrees(candidate, line) for candidate in lines), f"no {line!r} in\n{output}"


def agrees(candidate, line):
    if NUMBER.sub("#", candidate).split() != NUMBER.sub("#", line).split():
        return False
    pairs = zip(NUMBER.findall(candidate), NUMBER.findall(line))
    return all(abs(float(a) - float(b)) <= max(5e-4, 0.05 * abs(float(b))) for a, b in pairs)


def follow(page, folder):
    """Executes the blocks of a page in order."""
    output = ""
    for language, text in BLOCK.findall((TUTORIALS / f"{page}.md").read_text(encoding="utf-8")):
        if language in ("yaml", "python", "none"):
            name, body = re.match(r"# (\S+)\n(.*)", text, re.DOTALL).groups()
            (folder / name).write_text(body, encoding="utf-8")
        elif language == "sh" and text.startswith("sinew view"):
            view(text, folder)
        elif language == "sh":
            output = shell(text, folder)
        else:
            assert language == "text"
            assert_shows(output, text)


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """A folder in which the first tutorial was followed."""
    folder = tmp_path_factory.mktemp("tutorial")
    follow(FIRST, folder)
    return folder


def test_from_an_stl_file_to_inverse_control(first):
    assert (first / "out" / "finger" / "run.png").stat().st_size > 10_000


@pytest.mark.parametrize("page", sorted(path.stem for path in TUTORIALS.glob("*.md") if path.stem != FIRST))
def test_the_others(page, first, tmp_path):
    for name in ("finger.yaml", "finger.vtu"):
        shutil.copy(first / name, tmp_path)
    if page == "sweep_a_design":
        pytest.importorskip("distributed")
    follow(page, tmp_path)
