"""Error message if the package cannot be imported, and the list of its names."""

import os
import pathlib
import subprocess
import sys

import sinew


def test_a_wrong_interpreter_is_named_with_the_right_one(tmp_path):
    (tmp_path / "numpy.py").write_text("raise ModuleNotFoundError(\"No module named 'numpy'\")\n", encoding="ascii")
    package = str(pathlib.Path(sinew.__file__).parents[1])
    done = subprocess.run([sys.executable, "-c", "import sinew"], capture_output=True, text=True, check=False, timeout=60,
                          env={**os.environ, "PYTHONPATH": f"{tmp_path}:{package}"})
    assert done.returncode == 1
    assert "ImportError: No module named 'numpy'; sinew needs NumPy" in done.stderr
    assert "/usr/bin/python3" in done.stderr and sys.executable in done.stderr


def test_modules_that_are_imported_when_first_used_are_listed():
    names = dir(sinew)
    assert {"control", "estimate", "gym", "identify", "learn", "plan", "plot", "render", "sweep", "convergence", "load"} <= set(names)
    assert not [name for name in names if name.startswith("_") and not name.startswith("__")]
