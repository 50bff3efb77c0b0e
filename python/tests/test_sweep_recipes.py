"""The recipes of examples/sweep, run as programs with few samples."""

import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest
import sinew

for needed in ("distributed", "pandas", "h5py", "scipy", "matplotlib"):
    pytest.importorskip(needed)

import sinew.sweep  # noqa: E402

ROOT = pathlib.Path(__file__).parents[2]
TRUNK = ROOT / "examples" / "trunk" / "trunk.yaml"
TIP = [f"tip.position.{axis}" for axis in "xyz"]


def recipe(name, folder, *words):
    """Output of a recipe."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path), "MPLBACKEND": "Agg"}
    run = subprocess.run([sys.executable, str(ROOT / "examples" / "sweep" / f"{name}.py"), *words, "--workers", "2", "--out", str(folder)],
                         capture_output=True, text=True, check=False, timeout=120, env=environment, cwd=folder)  # fmt: skip
    assert run.returncode == 0, run.stderr[-2000:]
    return run.stdout


def test_the_workspace_of_the_trunk(tmp_path):
    told = recipe("workspace", tmp_path, "--samples", "16")
    table = sinew.sweep.load(tmp_path)
    assert len(table) == 16 and set(table["status"]) == {"done"} and "drew" in told
    assert (tmp_path / "workspace.png").stat().st_size > 10_000
    for axis in "xyz":
        low, high = map(float, re.search(rf"tip {axis} from +(\S+) to +(\S+) mm", told).groups())
        tip = 1e3 * table[f"tip.position.{axis}"]
        assert (low, high) == pytest.approx((tip.min(), tip.max()), abs=0.0051)  # the output has two decimals
    assert np.ptp(table[TIP[0]]) > 3e-3 and np.ptp(table[TIP[1]]) > 3e-3  # tensions of 0 to 1 N move the tip by some mm
    sim = sinew.load(TRUNK)
    for name in sim.actuators:
        sim.actuator(name).tension = table[f"actuators.{name}.command.tension"].iloc[7]
    sim.solve_static()
    assert table[TIP].iloc[7].to_numpy() == pytest.approx(sim.effector("tip").position, abs=1e-8)


def test_the_sensitivity_of_a_tip(tmp_path):
    told = recipe("sensitivity", tmp_path, "--base", "16")
    table = sinew.sweep.load(tmp_path)
    assert len(table) == 16 * 5 and set(table["status"]) == {"done"}
    for axis in "xz":
        found = sinew.sweep.indices(tmp_path, f"tip.{axis}")
        # With 16 points, the indices are rough; still, the modulus, varied by 20 %, clearly dominates.
        assert found["total"].idxmax() == "modulus" and found.loc["modulus", "total"] > 2.0 * found["total"].drop("modulus").max()
        printed = told.split(f"tip's {axis},")[1]
        assert float(re.search(r"modulus +(\S+)", printed)[1]) == pytest.approx(found.loc["modulus", "first"], abs=5.1e-4)
    # A cable farther from the axis bends the trunk more, and a stiffer trunk bends less.
    bent = np.hypot(table["tip.x"], table["tip.y"])
    slopes = np.linalg.lstsq(np.column_stack([table[["modulus", "density", "placement"]] / [450e3, 1100.0, 1.0], np.ones(80)]), bent, rcond=None)[0]
    assert slopes[0] < 0.0 < slopes[2]


def test_a_data_set(tmp_path):
    recipe("data_set", tmp_path, "--samples", "4")
    data, sim = np.load(tmp_path / "data.npz"), sinew.load(TRUNK)
    shape = (4, *sim.body("trunk").positions.shape)
    assert data["tensions"].shape == (4, 8) and data["ramp"].shape == (4,) and data["tip"].shape == (4, 3)
    assert data["positions"].shape == data["velocities"].shape == data["reactions"].shape == shape
    assert (data["tensions"] >= 0.0).all() and (data["tensions"] <= 1.0).all() and len(np.unique(data["ramp"])) == 4
    assert np.abs(data["velocities"]).max() > 0.01  # the trunk still moves after 0.2 s
    free = np.abs(data["positions"] - sim.body("trunk").rest_positions).max(axis=(0, 2)) > 0.0
    assert 0 < free.sum() < shape[1] and not data["reactions"][:, free].any() and data["reactions"][:, ~free].any()
