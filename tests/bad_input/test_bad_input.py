"""Every invalid input of cases.py causes a specific error and leaves the files on disk unchanged.

    SINEW_PROGRAM=build/release/bin/sinew PYTHONPATH=build/release/python \\
        /usr/bin/python3 -m pytest tests/bad_input
"""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess

import pytest
from cases import CASES, SCENE

PROGRAM = os.path.abspath(os.environ.get("SINEW_PROGRAM", "build/release/bin/sinew"))
SURFACES = pathlib.Path(__file__).resolve().parents[1] / "mesh" / "data_surface"
PATIENCE = 60  # s, time limit of the program
try:
    import sinew
except ImportError:  # builds without the Python package
    sinew = None


def snapshot(folder):
    """Names and contents of everything below a folder."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*")) if path.is_file()
    }


def prepare(case, folder):
    """Writes the case's files, the scene and an output folder of an earlier run."""
    text = SCENE
    for old, new in case.scene:
        assert old in text, f"{old!r} is not in the scene"
        text = text.replace(old, new, 1)
    for name, content in case.files:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if content == "CUBE":
            shutil.copy(SURFACES / "cube_ascii.stl", path)
        else:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
    (folder / "scene.yaml").write_bytes(text.encode("utf-8", "surrogateescape"))
    out = folder / "out"
    out.mkdir()
    for name in ("run.csv", "run.h5", "scene.yaml", "x.vtu"):
        (out / name).write_text(f"an earlier {name}")
    return out


def run_program(case, folder):
    """The error that the program prints: (kind, whole text)."""
    out = prepare(case, folder)
    before = snapshot(folder)
    line = [word.format(scene=folder / "scene.yaml", out=out, folder=folder) for word in case.line]
    result = subprocess.run([PROGRAM, *line], capture_output=True, text=True, timeout=PATIENCE,
                            cwd=folder, check=False)
    assert result.returncode == case.code, result.stderr
    if case.code == 2:
        assert snapshot(folder) == before, "files were changed"
    assert result.stderr.count("sinew: error: ") == 1, result.stderr
    error = re.search(r"^sinew: error: (.*\[([a-z-]+)\])\s*$", result.stderr, re.DOTALL | re.MULTILINE)
    assert error, f"no kind in: {result.stderr}"
    return error.group(2), error.group(1)


def run_call(case, folder):
    """The error that the call raises: (kind, whole text)."""
    if sinew is None:
        pytest.skip("this build has no Python package")
    with pytest.raises(sinew.Error) as caught:
        case.call(folder)
    return caught.value.kind, str(caught.value)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_broken_input(case, tmp_path):
    run = run_call if case.call else run_program
    kind, text = run(case, tmp_path)
    if os.environ.get("SINEW_SHOW"):
        print(f"{kind} | {text}".replace(str(tmp_path), "."))
    assert kind == case.kind, text
    message, _, remedy = text.partition("; ")
    assert case.place and case.place in message, text
    for words in case.says:
        assert words in text, f"{words!r} is not in: {text}"
    assert len(remedy) > len(f"[{kind}]") + 8, f"no remedy in: {text}"


def test_the_table_is_wide():
    assert len({case.name for case in CASES}) == len(CASES) >= 60
    assert len({case.kind for case in CASES}) >= 40
