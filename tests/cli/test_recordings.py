"""Recordings of the program: commands, probes and sensors, and plots, fits and sweeps.

    SINEW_PROGRAM=build/release/bin/sinew /usr/bin/python3 -m pytest tests/cli
"""

import csv
import json
import os
import re
import signal
import subprocess

import h5py
import numpy as np
import pytest
from program import CONTROL, DONE, PROGRAM, WRONG, rows_of, sinew


def test_commands_are_recorded(scene, tmp_path):
    path, out = scene(), tmp_path / "out"
    assert sinew("run", path, "--out", out, "--quiet").returncode == DONE
    rows = rows_of(out / "run.csv")
    told = [float(row["up.displacement_command [m]"]) for row in rows]
    assert told == pytest.approx(np.linspace(0, 0.004, 11))
    assert {row["up.tension_command [N]"] for row in rows} == {"nan"}
    with h5py.File(out / "run.h5") as file:
        assert file.attrs["format_version"] == 3
        assert np.array_equal(file["actuators/up/motion_command"], told)
        assert file["actuators/up/motion_command"].attrs["name"] == "up.displacement_command"
        assert file["actuators/up/motion_command"].attrs["unit"] == "m"
        assert np.isnan(file["actuators/up/effort_command"]).all()
        assert file["report/status"].attrs["meaning"].startswith("-1 start, 0 solved")
        assert file["energy/strain_energy"][-1] == float(rows[-1]["strain_energy [J]"])


def test_a_controller_commands_efforts(scene, tmp_path):
    path, out = scene(), tmp_path / "out"
    path.write_text(path.read_text() + CONTROL)
    assert sinew("run", path, "--out", out, "--quiet").returncode == DONE
    rows = rows_of(out / "run.csv")
    assert all(row["up.tension_command [N]"] == row["up.tension [N]"] for row in rows)
    assert max(float(row["up.tension_command [N]"]) for row in rows) > 0
    assert {row["up.displacement_command [m]"] for row in rows} == {"nan"}
    with h5py.File(out / "run.h5") as file:
        assert np.array_equal(file["report/error"], [float(row["error [m]"]) for row in rows])
        assert file["controller/tip/target"].shape == (len(rows), 3)


def make_older(folder):
    """Converts a recording to format 2."""
    with h5py.File(folder / "run.h5", "r+") as file:
        file.attrs["format_version"] = np.int64(2)
        for actuator in file["actuators"].values():
            for name in [name for name in actuator if name.endswith("_command")]:
                del actuator[name]
        for name in ("energy", "contact_resultants", "report/substeps", "report/controller"):
            if name in file:
                del file[name]
    rows = rows_of(folder / "run.csv")
    kept = [name for name in rows[0] if "_command [" not in name and name != "substeps"]
    with open(folder / "run.csv", "w", newline="", encoding="utf-8") as table:
        writer = csv.DictWriter(table, kept, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)


def test_an_older_recording_says_what_it_lacks(scene, tmp_path):
    out = tmp_path / "out"
    assert sinew("run", scene(), "--out", out, "--quiet").returncode == DONE
    make_older(out)
    told = sinew("info", out / "run.h5")
    assert told.returncode == DONE and "recorded without commands" in told.stdout, told.stderr
    assert "commands" in json.loads(sinew("info", out / "run.h5", "--json").stdout)["lacks"]
    done = sinew("plot", out)
    assert done.returncode == DONE and (out / "run.png").exists()
    assert re.fullmatch(r"sinew: remark: .*run\.csv: this run was recorded without commands\n", done.stderr)
    with subprocess.Popen([os.path.abspath(PROGRAM), "view", out, "--no-open", "--port", "0"], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE) as view:
        assert "the view is at" in view.stdout.readline()
        view.send_signal(signal.SIGINT)
        errors = view.communicate(timeout=60)[1]
    assert "recorded without commands" in errors
    with h5py.File(out / "run.h5", "r+") as file:
        file.attrs["format_version"] = np.int64(1)
    refused = sinew("info", out / "run.h5")
    assert refused.returncode == WRONG and "unsupported-version" in refused.stderr


def test_plot_draws_a_run(scene, tmp_path):
    out = tmp_path / "out"
    assert sinew("run", scene(), "--out", out, "--quiet").returncode == DONE
    done = sinew("plot", out)
    assert done.returncode == DONE and "run.png" in done.stdout, done.stderr
    assert not done.stderr
    assert (out / "run.png").read_bytes().startswith(b"\x89PNG")
    missing = sinew("plot", tmp_path)
    assert missing.returncode == WRONG and "file-not-found" in missing.stderr
    (out / "mine.png").write_bytes(b"a picture")
    assert sinew("run", scene(), "--out", out, "--quiet").returncode == DONE
    assert not (out / "run.png").exists()  # the plot of the previous run is removed
    assert (out / "mine.png").read_bytes() == b"a picture"


def test_a_sweep_is_run_resumed_and_plotted(scene, tmp_path):
    pytest.importorskip("distributed")
    pytest.importorskip("pandas")
    out = tmp_path / "out"
    words = ["sweep", scene(), "--vary", "bodies.beam.material.young_modulus=200kPa:300kPa:3", "--vary",
             "actuators.up.command.displacement=-1mm,0mm,1mm", "--measure", "tip.position", "--measure", "beam.strain_energy",
             "--duration", "50ms", "--workers", "1", "--out", out]
    wrong = sinew(*words[:-2], "--out", out, "--measure", "tip.positon")
    assert wrong.returncode == WRONG and "did you mean 'tip.position'" in wrong.stderr and not out.exists()
    done = sinew(*words)
    assert done.returncode == DONE and not done.stderr, done.stderr
    assert re.search(r"done +9\n", done.stdout)
    with h5py.File(out / "sweep.h5") as table:
        assert sorted(table["sample"]) == list(range(9))
        assert np.isfinite(table["outputs/tip.position"][:]).all()
    refused = sinew(*words)
    assert refused.returncode == WRONG and "--resume" in refused.stderr
    assert sinew(*words, "--resume").returncode == DONE
    drawn = sinew("plot", out)
    assert drawn.returncode == DONE and not drawn.stderr, drawn.stderr
    assert sorted(path.name for path in out.glob("*.png")) == ["parallel.png", "scatter.png", "surface.png", "workspace.png"]
    assert sinew("plot", out, "--kind", "surface", "-o", tmp_path / "one.png").returncode == DONE
    assert (tmp_path / "one.png").read_bytes().startswith(b"\x89PNG")


def test_probes_are_recorded_and_plotted(scene, tmp_path):
    probes = """probes:
  bend: {body: beam, bend: [{set: x_min}, {set: x_max}], about: y}
  axis: {body: beam, line: [0 10 10 mm, 100 10 10 mm], samples: 5}
effectors:"""
    path, out = scene(replace=("effectors:", probes)), tmp_path / "out"
    assert sinew("run", path, "--out", out, "--quiet").returncode == DONE
    rows, plain = rows_of(out / "probes.csv"), rows_of(out / "run.csv")
    assert [row["time [s]"] for row in rows] == [row["time [s]"] for row in plain]
    assert list(rows[0])[:3] == ["time [s]", "bend [rad]", "axis.length [m]"]
    assert float(rows[0]["axis.length [m]"]) == pytest.approx(0.1)
    assert float(rows[-1]["bend [rad]"]) < -0.05
    with h5py.File(out / "run.h5") as run:
        assert run["probes/bend"].attrs["kind"] == "bend"
        assert run["probes/bend/value"].attrs["unit"] == "rad"
        assert run["probes/bend/value"][-1] == float(rows[-1]["bend [rad]"])
        assert run["probes/axis/positions"].shape == (len(rows), 5, 3)
        assert run["probes/axis/positions"][-1, 4, 2] == float(rows[-1]["axis.4.z [m]"])
    done = sinew("plot", out)
    assert done.returncode == DONE and not done.stderr, done.stderr


def test_sensors_are_recorded_plotted_and_read_back(scene, tmp_path):
    sensors = """sensors:
  eye: {type: marker, body: beam, set: x_max, noise: 0.1 mm, rate: 50 Hz, delay: 20 ms, dropout: 10 %}
  skin: {type: stretch, body: beam, line: [0 10 10 mm, 100 10 10 mm], noise: 1e-3}
effectors:"""
    path, out = scene(replace=("effectors:", sensors)), tmp_path / "out"
    assert sinew("run", path, "--out", out, "--quiet").returncode == DONE
    rows, plain = rows_of(out / "sensors.csv"), rows_of(out / "run.csv")
    assert [row["time [s]"] for row in rows] == [row["time [s]"] for row in plain]
    assert list(rows[0])[:8] == ["time [s]", "eye.measured_x [m]", "eye.measured_y [m]", "eye.measured_z [m]", "eye.true_x [m]",
                                 "eye.true_y [m]", "eye.true_z [m]", "eye.sample_time [s]"]
    assert rows[0]["eye.measured_x [m]"] == "nan" and float(rows[-1]["eye.measured_x [m]"]) > 0.05
    assert not any("eye" in heading or "skin" in heading for heading in plain[0])
    with h5py.File(out / "run.h5") as run:
        assert run["sensors/eye"].attrs["kind"] == "marker"
        assert run["sensors/skin/measured"][-1] == float(rows[-1]["skin.measured"])
    done = sinew("plot", out)
    assert done.returncode == DONE and not done.stderr, done.stderr
    recorded = f"{{type: marker, body: beam, set: x_max, file: {out / 'sensors.csv'}, missing: lost}}"
    old = "{type: marker, body: beam, set: x_max, noise: 0.1 mm, rate: 50 Hz, delay: 20 ms, dropout: 10 %}"
    path.write_text(path.read_text().replace(old, recorded))
    assert sinew("run", path, "--out", tmp_path / "again", "--quiet").returncode == DONE
    again = rows_of(tmp_path / "again" / "sensors.csv")
    for name in list(rows[0])[1:4] + ["eye.sample_time [s]"]:
        assert [row[name] for row in again] == [row[name] for row in rows], name
    path.write_text(path.read_text().replace("missing: lost", "missing: error"))
    refused = sinew("run", path, "--out", tmp_path / "no")
    assert refused.returncode == WRONG and "sensors.csv:2" in refused.stderr and "[not-finite]" in refused.stderr


def test_fit_writes_a_material_that_a_scene_takes(scene, tmp_path):
    stretch = np.linspace(1.0, 3.0, 20)
    stress = 12.0 * 2 * (stretch - stretch**-2) + 0.3 * 4 * (stretch**2 + 2 / stretch - 3) * (stretch - stretch**-2)
    table = "\n".join(f"{a:.6f},{b:.8f}" for a, b in zip(stretch, stress))
    (tmp_path / "tensile.csv").write_text("stretch,nominal stress [kPa]\n" + table + "\n")
    if "Not available" in sinew("fit", "--help").stdout:
        pytest.skip("built without Ceres")
    done = sinew("fit", "tensile.csv", "--model", "yeoh2", "-o", "rubber.yaml", "--plot", "rubber.png", cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    assert "Drucker-stable" in done.stdout and "initial shear modulus 24 kPa" in done.stdout
    assert (tmp_path / "rubber.png").read_bytes().startswith(b"\x89PNG")
    text = (tmp_path / "rubber.yaml").read_text()
    c10 = float([line for line in text.splitlines() if line.startswith("c10")][0].split()[1])
    assert c10 == pytest.approx(12e3, rel=1e-4)
    path = scene(replace=("{model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}", "{file: rubber.yaml}"))
    assert sinew("run", path, "--duration", "20ms", "--out", tmp_path / "run", "--quiet").returncode == DONE
    every = sinew("fit", "tensile.csv", "--all", "--starts", "2", cwd=tmp_path)
    assert every.returncode == DONE and "arruda-boyce" in every.stdout and "ogden6" in every.stdout
    best = [line.split()[0] for line in every.stdout.splitlines() if line.endswith((" *", " * +"))]
    assert len(best) == 1 and f"\n{best[0]}:\n" in every.stdout
    part = sinew("fit", "tensile.csv", "--model", "yeoh1", "--max-stretch", "1.5", cwd=tmp_path)
    assert part.returncode == DONE and "; 5 in the range" in part.stdout, part.stdout
    none = sinew("fit", "tensile.csv", "--max-stretch", "1.01", cwd=tmp_path)
    assert none.returncode == WRONG and "too-few-points" in none.stderr
    missing = sinew("fit", "none.csv", cwd=tmp_path)
    assert missing.returncode == WRONG and "file-not-found" in missing.stderr
    for model, remedy in (("yeoh", "did you mean 'yeoh1'? the models are "), ("gent", "; the models are ")):
        wrong = sinew("fit", "tensile.csv", "--model", model, cwd=tmp_path)
        assert wrong.returncode == WRONG and "unknown-choice" in wrong.stderr
        assert remedy in wrong.stderr and "yeoh1, yeoh2, yeoh3, arruda-boyce" in wrong.stderr
