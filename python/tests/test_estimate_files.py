"""Readings in files, and `sinew estimate`."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
import sinew

pytest.importorskip("scipy")
pytest.importorskip("yaml")

import sinew.estimate  # noqa: E402
from sinew.estimate import files, replay  # noqa: E402

ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}


def write(folder, text):
    path = folder / "readings.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_units_missing_readings_and_gaps(tmp_path):
    path = write(tmp_path, "time [s],tip.x [mm],east.tension,status\n0,1.5,2,good\n0.1,,3,good\n0.2,nan,-,bad\n"
                           "1.2,-2,4,good\n1.3,0,1,good\n")
    record = files.read_readings(path)
    assert set(record.columns) == {"tip.x", "east.tension"}
    np.testing.assert_allclose(record.columns["tip.x"], [1.5e-3, np.nan, np.nan, -2e-3, 0.0])
    assert record.missing == {"tip.x": 2, "east.tension": 1}
    assert record.gaps == [(0.2, 1.2)]
    assert record.at(1) == {"east.tension": 3.0}
    record = files.read_readings(write(tmp_path, "time (ms),tip.x (cm),own [furlong]\n0,1,1\n500,2,1\n"), wanted=["tip.x"])
    np.testing.assert_allclose(record.time, [0.0, 0.5])
    np.testing.assert_allclose(record.columns["tip.x"], [0.01, 0.02])


@pytest.mark.parametrize(("text", "kind", "line"), [
    ("time,tip.x\n", "malformed-file", 0),
    ("tip.x\n1\n2\n", "malformed-file", 1),
    ("time,tip.x\n0,1\n0.1\n", "malformed-file", 3),
    ("time,tip.x\n0,1\n0,2\n", "non-monotonic-time", 3),
    ("time,tip.x\n0,1\n,2\n", "not-finite", 3),
    ("time,tip.x\n0,inf\n1,2\n", "not-finite", 2),
    ("time,tip.x [furlongs]\n0,1\n1,2\n", "unknown-unit", 1),
    ("time [mm],tip.x\n0,1\n1,2\n", "wrong-dimension", 1),
    ("time,tip.x (kPa)\n0,1\n1,2\n", "wrong-dimension", 1),
    ("time,air.pressure [mm]\n0,1\n1,2\n", "wrong-dimension", 1),
])
def test_files_that_are_wrong_name_the_line(tmp_path, text, kind, line):
    with pytest.raises(sinew.Error) as caught:
        files.read_readings(write(tmp_path, text))
    assert caught.value.kind == kind and caught.value.place.line == line
    assert caught.value.place.file.endswith("readings.csv") and caught.value.remedy


def test_columns_that_are_wanted_hold_numbers(tmp_path):
    path = write(tmp_path, "time,tip.x\n0,1\n1,high\n")
    with pytest.raises(sinew.Error) as caught:
        files.read_readings(path, wanted=["tip.x"])
    assert caught.value.kind == "wrong-type" and caught.value.place.line == 3
    with pytest.raises(sinew.Error) as caught:
        files.read_readings(path, wanted=["tip.y"])
    assert caught.value.kind == "unknown-name"
    with pytest.raises(sinew.Error) as caught:
        files.read_readings(tmp_path / "none.csv")
    assert caught.value.kind == "file-not-found"


def test_columns_become_commands_and_sensors(tmp_path):
    path = write(tmp_path, "time,tip.x,tip.y,east.tension,east.displacement,west.tension\n0,1,1,1,1,1\n")
    stds = {"tip.position": 1e-4, "*.tension": 0.1, "east.tension": 0.2}
    sensors, commanded = replay.measured_of(files.read_readings(path), stds, ["east", "west"])
    assert {s.name: s.std for s in sensors} == {"tip.x": 1e-4, "tip.y": 1e-4, "east.tension": 0.2, "west.tension": 0.1}
    assert commanded == {"east": "displacement", "west": "tension"}
    with pytest.raises(sinew.Error) as caught:
        replay.measured_of(files.read_readings(path), {"nose.*": 1.0}, [])
    assert caught.value.kind == "unknown-name"


def command(*words):
    return subprocess.run([sys.executable, "-m", "sinew.estimate", *map(str, words)], capture_output=True, text=True,
                          env=ENVIRONMENT, check=False)


@pytest.fixture
def recorded(scene, tmp_path):
    """Readings of the finger under a growing force on its tip, with a camera that loses the tip for a while."""
    sim, generator = sinew.load(scene), np.random.default_rng(0)
    lines = ["time [s],tip.x [mm],tip.y [mm],tip.z [mm],east.displacement [mm],east.tension [N]"]
    sim.actuator("east").displacement = 0.003
    for k in range(16):
        sim.actuator("push").force = 0.03 * k
        sim.solve_static()
        tip = 1e3 * sim.effector("tip").position + 0.05 * generator.standard_normal(3)
        seen = ",".join("" if 6 <= k < 9 else f"{x:.5f}" for x in tip)
        lines.append(f"{0.1 * k:.1f},{seen},3,{sim.actuator('east').tension + 0.01 * generator.standard_normal():.5f}")
    return write(tmp_path, "\n".join(lines) + "\n")


@pytest.mark.parametrize("method", ["settled", "extended", "unscented", "horizon"])
def test_command_line_estimates_a_force(scene, recorded, tmp_path, method):
    out = tmp_path / "out"
    done = command(scene, "--measured", recorded, "--std", "tip.*=0.05mm", "--std", "east.tension=10mN",
                   "--force", "hand=finger:0 0 80 mm:0.5N", "--method", method, "--out", out)
    assert done.returncode == 0, done.stderr
    assert "3 of 16 readings are missing" in done.stderr
    table = np.genfromtxt(out / "estimate.csv", delimiter=",", names=True, deletechars="", dtype=None, encoding="utf-8")
    force, deviation = table["hand.x_[N]"], table["hand.x.std_[N]"]
    truth = 0.03 * np.arange(16)
    assert np.abs((force - truth) / deviation)[9:].max() < 4.0
    assert deviation[-1] < 0.1
    assert deviation[8] > deviation[5]


def test_command_line_estimates_a_modulus(scene, recorded, tmp_path):
    out = tmp_path / "out"
    done = command(scene, "--measured", recorded, "--std", "east.tension=10mN",
                   "--parameter", "bodies.finger.material.young_modulus=300kPa:0.5", "--out", out)
    assert done.returncode == 0, done.stderr
    table = np.genfromtxt(out / "estimate.csv", delimiter=",", names=True, deletechars="", dtype=None, encoding="utf-8")
    assert table["bodies.finger.material.young_modulus"][0] == pytest.approx(400e3, rel=0.05)


def test_command_line_searches_a_place(scene, tmp_path):
    sim = sinew.load(scene)
    area = sinew.estimate.patches(sim, "finger", 12)[4]
    body = sim.body("finger")
    forces = np.zeros_like(np.asarray(body.external_forces))
    forces[area.nodes] = np.outer(area.weights, -0.8 * area.normal)
    body.external_forces = forces
    sim.solve_static()
    middle = body.positions[np.argmin(np.linalg.norm(np.array(body.rest_positions) - [0.01, 0, 0.05], axis=1))]
    rest = np.array(body.rest_positions)[np.argmin(np.linalg.norm(np.array(body.rest_positions) - [0.01, 0, 0.05], axis=1))]
    tip = sim.effector("tip").position
    heads = [f"{name}.{axis} [m]" for name in ("tip", "side") for axis in "xyz"]
    path = write(tmp_path, ",".join(["time [s]", *heads]) + "\n" + ",".join(map(repr, [0.0, *map(float, tip), *map(float, middle)])) + "\n")
    out = tmp_path / "out"
    done = command(scene, "--measured", path, "--std", "tip.*=0.02mm", "--std", "side.*=0.02mm", "--search", "finger:12:1N", "--out", out,
                   "--marker", "side=finger:" + " ".join(f"{1e3 * x:.9g}" for x in rest) + " mm")
    assert done.returncode == 0, done.stderr
    table = np.genfromtxt(out / "estimate.csv", delimiter=",", names=True, deletechars="", dtype=None, encoding="utf-8")
    assert table["patch"] == 4 and table["status"] == "found"
    np.testing.assert_allclose([table[f"force.{axis}_[N]"] for axis in "xyz"], -0.8 * area.normal, atol=0.2)


def test_command_line_refuses_wrong_input(scene, recorded, tmp_path):
    good = ["--measured", recorded, "--std", "tip.*=0.05mm", "--force", "hand=finger:0 0 80 mm:0.5N"]
    for words, text in [
        ([scene, *good[:4]], "no-unknowns"),
        ([scene, *good, "--std", "nose.x=1mm"], "unknown-name"),
        ([scene, *good[:4], "--force", "hand=finger:0 0 80 mm:1m"], "wrong-dimension"),
        ([scene, *good[:4], "--force", "hand=finger"], "bad-argument"),
        ([scene, *good, "--method", "magic"], "unknown-choice"),
        ([scene, "--measured", tmp_path / "none.csv", *good[2:]], "file-not-found"),
    ]:
        done = command(*words, "--out", tmp_path / "out")
        assert done.returncode == 2 and text in done.stderr, (words, done.stderr)
    assert not pathlib.Path(tmp_path / "out").exists()
