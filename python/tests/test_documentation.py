"""The code of the guide and the examples run unchanged."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import sinew
import yaml

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples" / "python").glob("*.py")) + [
    ROOT / "examples" / "bending_actuator" / "simulate.py",
    ROOT / "examples" / "fluidic_arm" / "identify.py",
]
SCENES = sorted((ROOT / "examples").rglob("*.yaml"))


def test_the_guide(tmp_path, monkeypatch, capsys):
    # The guide writes files, so it runs in a folder that looks like the root of the repository.
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) > 8
    names = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"docs/python.md, block {number}", "exec"), names)
    assert names["recorded"]["error"][-1] < 1e-3
    assert "long_0" in capsys.readouterr().out


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples(example, tmp_path):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "MPLBACKEND": "Agg"}
    result = subprocess.run(
        [sys.executable, str(example)],
        cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300, check=False,
    )
    assert result.returncode == 0, result.stderr
    assert len(result.stdout.splitlines()) >= 3


def test_no_page_has_marks_of_an_unfinished_merge():
    pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]
    assert len(pages) > 20
    marked = [page.name for page in pages if re.search(r"^(<{7}|>{7}|={7})( |$)", page.read_text(encoding="utf-8"), re.MULTILINE)]
    assert not marked


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: str(scene.relative_to(ROOT)))
def test_example_scenes(scene):
    sim = sinew.load(scene)
    start = {name: body.positions.copy() for name, body in sim.bodies.items()}
    sim.step(round(1.0 / sim.time_step))
    described = yaml.safe_load(scene.read_text())["bodies"]
    for name, body in sim.bodies.items():
        robot = name.split(".")[0]  # name of the URDF robot of a link; its root link is fixed
        if described[robot].get("fixed") is True or name == "arm.base":
            continue
        moved = np.abs(body.positions - start[name]).max()
        assert 1e-4 < moved < 0.5, f"{name} moved by {moved} m in a second"
    if sim.controller is not None:
        assert sim.controller.error < 1e-3
