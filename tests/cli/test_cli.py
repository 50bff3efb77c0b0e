"""The sinew program from outside: what it prints, writes and returns.

    SINEW_PROGRAM=build/release/bin/sinew /usr/bin/python3 -m pytest tests/cli
"""

import csv
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

import h5py
import meshio
import numpy as np
import pytest

PROGRAM = os.environ.get("SINEW_PROGRAM", "build/release/bin/sinew")
ROOT = pathlib.Path(__file__).resolve().parents[2]
DONE, FAILED, WRONG = 0, 1, 2

SCENE = """sinew: 1
time_step: 10 ms
{more}
bodies:
  beam:
    type: fem
    mesh: {{shape: block, length: 100 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}}
    material: {{model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}}
    density: 1070 kg/m^3
    fixed: [{{set: x_min}}]
actuators:
  up:
    type: cable
    body: beam
    points: ["0 10 16 mm", "30 10 16 mm", "60 10 16 mm", "98 10 16 mm"]
    command: {{displacement: {{ramp: {{from: 0 mm, to: 4 mm, start: 0 s, duration: 0.1 s}}}}}}
effectors:
  tip: {{body: beam, point: 100 10 10 mm}}
"""


def sinew(*arguments, cwd=None, timeout=120):
    """Runs the program to its end."""
    words = [os.path.abspath(PROGRAM), *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True, cwd=cwd, timeout=timeout, check=False)


@pytest.fixture(name="scene")
def write_scene(tmp_path):
    def write(more="", name="beam.yaml", replace=("", "")):
        path = tmp_path / name
        path.write_text(SCENE.format(more=more).replace(*replace) if replace[0] else SCENE.format(more=more))
        return path

    return write


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_run_records_what_was_asked(scene, tmp_path):
    path = scene()
    result = sinew("run", path, cwd=tmp_path)
    assert result.returncode == DONE, result.stderr
    assert result.stderr == "", "no progress bar unless there is a terminal"
    assert "real-time factor" in result.stdout
    folder = tmp_path / "out" / "beam"  # named after the scene
    assert sorted(p.name for p in folder.iterdir()) == ["run.csv", "run.h5", "scene.yaml"]
    rows = rows_of(folder / "run.csv")
    assert len(rows) == 11, "the signal lasts 0.1 s: ten steps and the start"
    assert float(rows[-1]["time [s]"]) == pytest.approx(0.1)
    assert float(rows[-1]["up.displacement [m]"]) == pytest.approx(0.004, abs=2e-4)
    assert float(rows[-1]["tip.z [m]"]) > 0.0101, "an upper cable bends the beam up"
    with h5py.File(folder / "run.h5") as file:
        assert file.attrs["format"] == "sinew-run"
        assert file["positions/beam"].shape[0] == len(file["time"]) == 11
        assert file["positions/beam"].attrs["unit"] == "m"
        tip = [float(rows[-1][f"tip.{axis} [m]"]) for axis in "xyz"]
        assert np.array_equal(file["effectors/tip/position"][-1], tip)
        assert "velocities" not in file, "quasi-static"
        assert file["scene"][()].decode() == (folder / "scene.yaml").read_text()


def test_flagged_steps_end_with_one_unless_told_to_keep_going(tmp_path):
    trunk = ROOT / "examples" / "trunk" / "trunk.yaml"
    pull = ["--duration", "1.5s", "--set", "actuators.long_0.command.displacement.ramp.to=30mm"]
    rough = ["--set", "solver={method: one-linearisation, tangent: corotated}",
             "--set", "actuators.long_0.geometric_stiffness=false"]
    solved = sinew("run", trunk, *pull, "--out", "solved", cwd=tmp_path)
    assert solved.returncode == DONE and solved.stderr == "", solved.stderr
    assert {row["status"] for row in rows_of(tmp_path / "solved" / "run.csv")} == {"start", "solved"}
    flagged = sinew("run", trunk, *pull, *rough, "--out", "rough", cwd=tmp_path)
    assert flagged.returncode == FAILED
    assert "steps are not-in-equilibrium, the first at t = " in flagged.stderr
    assert "solver: newton" in flagged.stderr
    assert "not-in-equilibrium" in {row["status"] for row in rows_of(tmp_path / "rough" / "run.csv")}
    told = sinew("run", trunk, *pull, *rough, "--keep-going", "--out", "rough", cwd=tmp_path)
    assert told.returncode == DONE and "not-in-equilibrium" in told.stderr


@pytest.mark.parametrize("step_ms", [4, 2])
def test_the_energy_ledger_is_kept(tmp_path, step_ms):
    swing = ROOT / "examples" / "beam" / "swing.yaml"
    result = sinew("run", swing, "--duration", "0.4s", "--set", f"time_step={step_ms}ms",
                   "--set", "bodies.beam.damping={mass: 0 1/s}", "--out", "out", cwd=tmp_path)
    assert result.returncode == DONE, result.stderr
    rows = rows_of(tmp_path / "out" / "run.csv")
    column = {name: np.array([float(row[f"{name} [J]"]) for row in rows]) for name in (
        "strain_energy", "kinetic_energy", "gravity_energy", "actuator_work", "dissipation",
        "numerical_loss")}
    energy = column["strain_energy"] + column["kinetic_energy"] + column["gravity_energy"]
    assert abs(energy[0]) < 1e-20 and column["actuator_work"][0] == 0.0
    assert column["gravity_energy"].min() < -1e-3 and column["kinetic_energy"].max() > 1e-3
    np.testing.assert_allclose(column["numerical_loss"], column["actuator_work"] - energy, atol=1e-15)
    assert np.all(column["dissipation"] == 0.0)
    # Backward Euler loses energy, less of it with a smaller step, and never makes any.
    assert np.all(np.diff(column["numerical_loss"]) > -1e-9)
    share = column["numerical_loss"][-1] / -column["gravity_energy"].min()
    assert 0.0 < share < 0.06 * step_ms


def test_the_recorded_scene_runs_the_same(scene, tmp_path):
    table = tmp_path / "pull.csv"
    table.write_text("0, 0\n0.05, 3\n")
    path = scene(replace=("{ramp: {from: 0 mm, to: 4 mm, start: 0 s, duration: 0.1 s}}",
                          "{file: pull.csv, unit: mm}"))
    first = sinew("run", path, "--out", tmp_path / "a", "--set", "time_step=5ms")
    assert first.returncode == DONE, first.stderr
    again = sinew("run", tmp_path / "a" / "scene.yaml", "--out", tmp_path / "b", cwd="/")
    assert again.returncode == DONE, again.stderr
    assert (tmp_path / "a" / "run.csv").read_bytes() == (tmp_path / "b" / "run.csv").read_bytes()
    assert len(rows_of(tmp_path / "a" / "run.csv")) == 11


def test_vtk_series(scene, tmp_path):
    result = sinew("run", scene(), "--duration", "30ms", "--vtk", "--quiet", "--out", tmp_path / "o")
    assert result.returncode == DONE, result.stderr
    assert result.stdout == ""
    assert len(list((tmp_path / "o" / "run").glob("*.vtu"))) == 4
    assert (tmp_path / "o" / "run.pvd").read_text().count("DataSet") == 4
    last = meshio.read(sorted((tmp_path / "o" / "run").glob("*.vtu"))[-1])
    assert {"rest_position", "velocity", "reaction"} <= set(last.point_data)
    assert "displacement" not in last.point_data  # would be added twice by ParaView's Warp By Vector
    stress = last.cell_data["cauchy_stress"][0].reshape(-1, 3, 3)
    deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    assert last.cell_data["von_mises_stress"][0] == pytest.approx(np.sqrt(1.5 * (deviator**2).sum((1, 2))), rel=1e-6)  # float32
    assert np.abs(last.point_data["reaction"]).max() > 0


def test_a_run_is_drawn(scene, tmp_path):
    done = sinew("run", scene(), "--duration", "0.2s", "--video", tmp_path / "film", "--quiet", "--out", tmp_path / "o")
    assert done.returncode == DONE, done.stderr
    assert done.stdout == "" and len(list((tmp_path / "film").glob("*.png"))) == 7
    assert sorted(p.name for p in (tmp_path / "o").iterdir()) == ["run.csv", "run.h5", "scene.yaml"]


def test_run_writes_its_motion(scene, tmp_path):
    file = tmp_path / "motion.glb"
    done = sinew("run", scene(), "--duration", "0.2s", "--glb", file, "--quiet", "--out", tmp_path / "o")
    assert done.returncode == DONE, done.stderr
    data = file.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    motion = json.loads(data[20 : 20 + length])
    assert data[:4] == b"glTF" and [mesh["name"] for mesh in motion["meshes"]] == ["beam", "up"]

    def floats(index):
        view = motion["bufferViews"][motion["accessors"][index]["bufferView"]]
        start = 28 + length + view["byteOffset"]
        return np.frombuffer(data[start : start + view["byteLength"]], dtype=np.float32)

    # Thirty frames a second of the steps of 10 ms: at 0, 40, 80, 120, 160 and 200 ms.
    times = floats(motion["animations"][0]["samplers"][0]["input"])
    assert times == pytest.approx(0.04 * np.arange(6), abs=1e-6)
    with h5py.File(tmp_path / "o" / "run.h5") as run:
        positions = run["positions/beam"][()]
        cells = run["mesh/beam/tetrahedra"][()]
    faces = np.sort(cells[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3), axis=1)
    sides, count = np.unique(faces, axis=0, return_counts=True)
    outside = np.unique(sides[count == 1])
    surface = motion["meshes"][0]["primitives"][0]
    first = floats(surface["attributes"]["POSITION"]).reshape(-1, 3)
    last = first + floats(surface["targets"][-1]["POSITION"]).reshape(-1, 3)
    for shown, there in ((first, positions[0]), (last, positions[-1])):
        assert np.sort(shown, axis=0) == pytest.approx(np.sort(there[outside], axis=0), abs=1e-7)
    assert np.abs(last - first).max() > 1e-3


def test_a_video_that_cannot_be_written_is_noticed_before_the_run(scene, tmp_path):
    for name, more, kind in (("a.avi", "", "unknown-format"), ("film", "record: {states: false}", "bad-argument")):
        done = sinew("run", scene(more=more), "--video", tmp_path / name, "--out", tmp_path / "o")
        assert done.returncode == WRONG and f"[{kind}]" in done.stderr
        assert not (tmp_path / "o").exists() and not (tmp_path / name).exists()


def test_threads_give_the_same_bits(scene, tmp_path):
    for threads in (1, 3):
        done = sinew("run", scene(), "--threads", threads, "--out", tmp_path / str(threads))
        assert done.returncode == DONE, done.stderr
    assert (tmp_path / "1" / "run.csv").read_bytes() == (tmp_path / "3" / "run.csv").read_bytes()


CONTROL = """
controllers:
  follow:
    type: inverse
    effectors: {tip: {target: {circle: {centre: 97 10 10 mm, radius: 4 mm, normal: 1 0 0, period: 0.2 s}}}}
"""


def test_a_controller_is_attached_unless_none(scene, tmp_path):
    path = scene()
    path.write_text(path.read_text() + CONTROL)
    steered = sinew("run", path, "--duration", "0.3 s", "--out", tmp_path / "a")
    assert steered.returncode == DONE, steered.stderr
    assert "mean error after 0.2 s" in steered.stdout
    rows = rows_of(tmp_path / "a" / "run.csv")
    assert rows[0]["controller"] == "start"
    assert {r["controller"] for r in rows[1:]} <= {"on-target", "moving", "rate-limited", "out-of-reach"}
    assert float(rows[5]["tip.target_x [m]"]) == pytest.approx(0.097)
    direct = sinew("run", path, "--duration", "0.05 s", "--controller", "none", "--out", tmp_path / "b")
    assert direct.returncode == DONE, direct.stderr
    assert rows_of(tmp_path / "b" / "run.csv")[-1]["controller"] == "none"
    wrong = sinew("run", path, "--controller", "folow")
    assert wrong.returncode == WRONG and "did you mean 'follow'?" in wrong.stderr


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_runs_end_cleanly(scene, tmp_path, how):
    out = tmp_path / "o"
    words = [os.path.abspath(PROGRAM), "run", str(scene()), "--duration", "1000s", "--out", str(out)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        table = out / "run.csv"
        for _ in range(600):
            if table.exists() and table.read_text().count("\n") > 6:  # and the header
                break
            time.sleep(0.05)
        process.send_signal(how)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == DONE
        assert "interrupted" in errors
    rows = rows_of(table)
    with h5py.File(out / "run.h5") as file:
        assert len(file["time"]) == len(rows) > 5
        assert file["time"][-1] == float(rows[-1]["time [s]"])


# 1681 points on a floor, more than Newton's method for contacts takes: one law takes far longer than the test.
LONG_STEP = """sinew: 1
gravity: 0 0 -9.81 m/s^2
integrator: backward-euler
duration: 1 s
bodies:
  block:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 60 mm, height: 3 mm, element_size: 1.5 mm}
    material: {young_modulus: 500 kPa, poisson_ratio: 0.3}
    density: 1000 kg/m^3
contacts:
  floor:
    body: block
    surface: {plane: {point: 0 0 -0.01 mm}}
    nodes: {plane: {point: 0 0 0 mm, within: 0.1 mm}}
    friction: 0.5
"""


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_a_long_step_tells_of_itself_and_can_be_ended(tmp_path, how):
    (tmp_path / "long.yaml").write_text(LONG_STEP)
    out = tmp_path / "o"
    words = [os.path.abspath(PROGRAM), "run", str(tmp_path / "long.yaml"), "--out", str(out)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        line = process.stderr.readline()
        assert re.match(r"sinew: t = \S+ s: this step has taken \d+ s: iteration \d+, residual \S+, ", line), line
        assert line.endswith("; the contacts have 1681 points: use fewer, or `aggregate`\n"), line
        sent = time.monotonic()
        process.send_signal(how)
        _, errors = process.communicate(timeout=60)
        assert time.monotonic() - sent < 10
        assert process.returncode == DONE
        assert "interrupted at t = " in errors
    rows = rows_of(out / "run.csv")
    with h5py.File(out / "run.h5") as file:
        assert len(file["time"]) == len(rows) >= 1


def test_a_long_step_in_the_view_can_be_ended(tmp_path):
    (tmp_path / "long.yaml").write_text(LONG_STEP)
    words = [os.path.abspath(PROGRAM), "view", str(tmp_path / "long.yaml"), "--no-open", "--port", "0"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as view:
        assert "the view is at" in view.stdout.readline()
        time.sleep(3)  # into the first step
        sent = time.monotonic()
        view.send_signal(signal.SIGINT)
        view.communicate(timeout=60)
        assert time.monotonic() - sent < 10
        assert view.returncode == DONE


def test_rubber_takes_the_exact_tangent_in_place_of_the_rotated_one(scene, tmp_path):
    soft = ["--set", "solver.tangent=corotated", "--set", "bodies.beam.material.model=neo-hookean", "--duration", "0.05s"]
    told = sinew("run", scene(), *soft, "--out", "o", cwd=tmp_path)
    assert told.returncode == DONE and "'beam' has no corotated tangent" in told.stderr
    assert told.stderr.rstrip().endswith("[other-tangent]") and told.stderr.count("\n") == 1
    iterations = [float(row["iterations"]) for row in rows_of(tmp_path / "o" / "run.csv")]
    assert max(iterations) <= 6
    plain = sinew("run", scene(), "--set", "solver.tangent=corotated", "--duration", "0.05s", "--out", "p", cwd=tmp_path)
    assert plain.stderr == ""


def test_a_run_that_fails_keeps_what_it_recorded(scene, tmp_path):
    # A soft beam crushed by a force that no step can follow.
    path = scene(replace=("command: {displacement: {ramp: {from: 0 mm, to: 4 mm, start: 0 s, duration: 0.1 s}}}",
                          "command: {tension: {ramp: {from: 0 N, to: 1e7 N, start: 0.05 s, duration: 0.05 s}}}"))
    result = sinew("run", path, "--duration", "1s", "--out", tmp_path / "o")
    assert result.returncode == FAILED, result.stdout + result.stderr
    assert result.stderr.startswith("sinew: error: step ")
    assert "body beam" in result.stderr
    rows = rows_of(tmp_path / "o" / "run.csv")
    assert 6 <= len(rows) < 101
    with h5py.File(tmp_path / "o" / "run.h5") as file:
        assert len(file["time"]) == len(rows)
        assert np.isfinite(file["positions/beam"][:]).all()


def test_wrong_input_leaves_folders_alone(scene, tmp_path):
    out = tmp_path / "o"
    assert sinew("run", scene(), "--out", out).returncode == DONE
    before = {p: p.read_bytes() for p in out.iterdir()}
    broken = scene("gravity: 3 kg", name="broken.yaml")
    for arguments in (["run", broken], ["run", scene(), "--set", "time_step=5 kg"],
                      ["run", scene(), "--duration", "-1s"], ["run", tmp_path / "none.yaml"]):
        assert sinew(*arguments, "--out", out).returncode == WRONG
        assert sinew(*arguments, "--out", tmp_path / "new").returncode == WRONG
    assert {p: p.read_bytes() for p in out.iterdir()} == before
    assert not (tmp_path / "new").exists()


def test_the_commands_of_the_readme_work_as_printed(tmp_path):
    text = (ROOT / "README.md").read_text(encoding="utf-8").split("## Your own robot")[1].split("## What works")[0]
    scenes = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)
    commands = re.findall(r"^    build/release/bin/sinew ([^#\n]*)", text, re.MULTILINE)
    assert len(scenes) == 1 and len(commands) == 4
    (tmp_path / "finger.yaml").write_text(scenes[0])
    for command in commands:
        done = sinew(*command.split(), cwd=tmp_path, timeout=300)
        assert done.returncode == DONE and not done.stderr, (command, done.stderr)
    out = tmp_path / "out" / "finger"
    assert (out / "run.pvd").exists()
    last = rows_of(out / "run.csv")[-1]
    assert last["status"] == "solved"
    assert float(last["pull.displacement [m]"]) == pytest.approx(0.005, rel=1e-6)


def test_without_an_end_the_remedy_is_named(scene):
    path = scene(replace=("{displacement: {ramp: {from: 0 mm, to: 4 mm, start: 0 s, duration: 0.1 s}}}",
                          "{displacement: 1 mm}"))
    result = sinew("run", path)
    assert result.returncode == WRONG
    assert "--duration 5s" in result.stderr and "[missing-key]" in result.stderr


def test_a_full_disk_fails_the_run(scene, tmp_path):
    # A file system of its own would need root; the limit on file sizes acts alike.
    limited = f"ulimit -f 2000; trap '' XFSZ; exec '{os.path.abspath(PROGRAM)}' run '{scene()}' --duration 20s --out '{tmp_path}/o'"
    result = subprocess.run(["bash", "-c", limited], capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == FAILED, result.stderr
    assert "[recording-failed]" in result.stderr
    assert len(rows_of(tmp_path / "o" / "run.csv")) > 2
    with h5py.File(tmp_path / "o" / "run.h5") as file:
        assert len(file["time"]) >= 1
        assert np.isfinite(file["positions/beam"][:]).all()


WRONG_ARGUMENTS = [
    ([], "bad-argument", "the commands are run"),
    (["rnu"], "unknown-option", "did you mean 'run'?"),
    (["run"], "bad-argument", "SCENE"),
    (["run", "--durration", "5s", "a.yaml"], "unknown-option", "did you mean --duration?"),
    (["bench", "a.yaml", "--step", "3"], "unknown-option", "did you mean --steps?"),
    (["run", "a.yaml", "b.yaml"], "bad-argument", "b.yaml"),
    (["run", "none.yaml"], "file-not-found", "none.yaml"),
    (["run", "{scene}", "--duration", "5mm"], "wrong-dimension", "--duration"),
    (["run", "{scene}", "--duration", "soon"], "not-a-number", "--duration"),
    (["run", "{scene}", "--duration", "0s"], "out-of-range", "--duration"),
    (["run", "{scene}", "--duration", "5 parsec"], "unknown-unit", "--duration"),
    (["run", "{scene}", "--duration", "1e12 s"], "out-of-range", "steps"),
    (["run", "{scene}", "--threads", "0"], "out-of-range", "--threads"),
    (["run", "{scene}", "--set", "time_step"], "bad-argument", "time_step"),
    (["run", "{scene}", "--set", "time_stp=1ms"], "unknown-key", "time_step"),
    (["run", "{scene}", "--set", "actuators.upp.command.tension=1N"], "unknown-name", "up"),
    (["run", "{scene}", "--controller", "x"], "unknown-name", "--controller"),
    (["run", "{scene}", "--out", "/proc/nothing/here"], "file-unwritable", "--out"),
    (["bench", "{scene}", "--steps", "0"], "out-of-range", "--steps"),
    (["bench", "{scene}", "--steps", "many"], "bad-argument", "--steps"),
    (["bench", "{scene}", "--tangent", "best"], "unknown-choice", "exact, projected or corotated"),
    (["validate", "patch", "--json"], "unknown-option", "unknown option '--json'"),
    (["validate", "patch", "--lst"], "unknown-option", "did you mean --list?"),
    (["validate", "--jobs", "two"], "bad-argument", "--jobs"),
    (["info"], "bad-argument", "FILE"),
    (["info", "none.vtu"], "file-not-found", "none.vtu"),
    (["info", "{scene}", "--units", "mm"], "unknown-option", "did you mean --unit?"),
    (["info", "{folder}"], "file-unreadable", "give a mesh, a surface, a scene, a saved state, or the folder of a run"),
    (["info", "{junk}"], "unknown-format", "junk"),
    (["info", "{junk}", "--unit", "kg"], "wrong-dimension", "--unit"),
    (["mesh", "-o", "a.vtu"], "bad-argument", "--shape"),
    (["mesh", "--shape", "torus", "-o", "a.vtu"], "unknown-choice", "torus"),
    (["mesh", "--shape", "block", "-o", "a.msh"], "unknown-format", ".vtu"),
    (["mesh", "--shape", "block", "-o", "/proc/nothing/a.vtu"], "file-unwritable", "/proc/nothing"),
    (["mesh", "a.stl", "-o", "a.vtu"], "bad-argument", "--size"),
    (["mesh", "none.stl", "-o", "a.vtu", "--size", "5mm"], "file-not-found", "none.stl"),
    (["mesh", "--shape", "block", "--size", "-5mm", "-o", "a.vtu"], "out-of-range", "--size"),
    (["mesh", "--shape", "block", "--set", "lenght=5mm", "-o", "a.vtu"], "unknown-key", "did you mean 'length'"),
    (["mesh", "--shape", "block", "--set", "length=5kg", "-o", "a.vtu"], "wrong-dimension", "length"),
    (["mesh", "--shape", "block", "--set", "length", "-o", "a.vtu"], "bad-argument", "length"),
    (["mesh", "a.stl", "--size", "5mm", "--set", "length=5mm", "-o", "a.vtu"], "bad-argument", "--set"),
    (["run", "{scene}", "--check", "--set", "bodies.beam.fixed=[{{set: x_mn}}]"], "unknown-set", "x_mi"),
    (["completion", "tcsh"], "unknown-choice", "use one of bash, zsh, fish"),
    (["run", "{scene}", "--glb", "motion.gltf"], "unknown-format", "*.glb"),
    (["run", "{scene}", "--glb", "none/motion.glb"], "file-unwritable", "none/motion.glb"),
    (["view", "{scene}", "--no-open", "--port", "99999"], "out-of-range", "65535"),
    (["view", "{scene}", "--no-open", "--host", "nowhere"], "bad-argument", "127.0.0.1"),
    (["view", "{scene}", "--no-open", "--speed", "1000"], "out-of-range", "100"),
]


@pytest.mark.parametrize("arguments, kind, words", WRONG_ARGUMENTS,
                         ids=[" ".join(a) or "nothing" for a, _, _ in WRONG_ARGUMENTS])
def test_wrong_arguments(arguments, kind, words, scene, tmp_path):
    (tmp_path / "junk").write_bytes(b"\x00\x01junk")
    names = {"scene": scene(), "folder": tmp_path, "junk": tmp_path / "junk"}
    before = sorted(tmp_path.rglob("*"))
    result = sinew(*(a.format(**names) for a in arguments), cwd=tmp_path)
    assert result.returncode == WRONG, result.stdout + result.stderr
    assert result.stderr.startswith("sinew: error: ") and f"[{kind}]" in result.stderr, result.stderr
    assert words in result.stderr
    assert result.stdout == ""
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("command", [[], ["run"], ["bench"], ["info"], ["mesh"], ["validate"], ["schema"], ["plot"], ["sweep"], ["estimate"], ["convergence"],
                                     ["completion"]],
                         ids=lambda c: " ".join(c) or "sinew")
def test_help(command):
    result = sinew(*command, "--help")
    assert result.returncode == DONE and result.stderr == ""
    examples = re.findall(r"^  (sinew .*)", result.stdout, re.MULTILINE)
    assert examples
    if command:
        assert all(command[0] in line for line in examples)  # its own, not the program's


def test_version():
    assert sinew("--version").stdout.startswith("sinew 0.")


def test_schema_and_reference_are_those_of_the_documentation():
    schema = sinew("schema").stdout
    assert json.loads(schema) == json.loads((ROOT / "docs" / "scene.schema.json").read_text())
    assert sinew("reference").stdout.startswith("# ")


def test_a_check_builds_and_runs_nothing(scene, tmp_path):
    path = scene()
    result = sinew("run", path, "--check", cwd=tmp_path)
    assert result.returncode == DONE and result.stderr == ""
    assert "240 tet4 elements" in result.stdout and re.search(r"would run +0.1 s in 10 steps", result.stdout)
    assert list(tmp_path.iterdir()) == [path]


COMPLETIONS = [
    ("sinew ru", {"run"}, {"bench"}),
    ("sinew ''", {"run", "mesh", "convergence"}, {"reference"}),
    ("sinew --", {"--help", "--version"}, {"run"}),
    ("sinew run --v", {"--vtk", "--video"}, {"--set"}),
    ("sinew mesh --shape r", {"ribbed-finger"}, {"block"}),
    ("sinew run be", {"beam.yaml"}, {"--set"}),
    ("sinew completion ''", {"bash", "zsh", "fish"}, {"beam.yaml"}),
]
# A script for each shell: what comes first, then what completes the words of a case.
COMPLETE = {
    "bash": ("source <({program} completion bash)",
             "COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _sinew; printf '%s\\n' \"${{COMPREPLY[@]}}\""),
    # What zsh's own functions would offer is printed: words that begin as the one at the cursor does.
    "zsh": ("""compdef() {{ }}
offer() {{ for word in "$@"; do [[ $word == $PREFIX* ]] && print -r -- $word; done }}
compadd() {{ shift; offer "$@" }}
_files() {{ offer *(N) }}
_describe() {{ local -a all; all=(${{(P)@[-1]}}); offer ${{all%%:*}} }}
source <({program} completion zsh)""", "words=({words}); CURRENT=$#words; PREFIX=$words[CURRENT]; _sinew"),
    "fish": ("{program} completion fish | source", "complete -C \"$(string replace \"''\" '' \"{words}\")\""),
}  # fmt: skip


@pytest.mark.parametrize("shell", COMPLETE)
def test_shells_complete(shell, scene):
    if shutil.which(shell) is None:
        pytest.skip(f"without {shell}")
    first, each = COMPLETE[shell]
    lines = [first.format(program=os.path.abspath(PROGRAM))]
    for words, _, _ in COMPLETIONS:
        lines += [each.format(words=words), "echo @@"]
    plain = {"bash": ["--norc"], "zsh": ["-f"], "fish": ["--no-config"]}[shell]
    found = subprocess.run([shell, *plain, "-c", "\n".join(lines)], capture_output=True, text=True, cwd=scene().parent, check=True)
    assert found.stderr == ""
    answers = found.stdout.split("@@\n")
    assert len(answers) == len(COMPLETIONS) + 1
    for answer, (words, some, without) in zip(answers, COMPLETIONS):
        offered = {row.split("\t")[0] for row in answer.splitlines()}  # fish: word, tab, description
        assert some <= offered and not without & offered, (words, offered)


def test_shapes_have_the_dimensions_that_are_asked_for(tmp_path):
    made = sinew("mesh", "--shape", "capsule", "--set", "radius=5mm", "--set", "length=2cm", "--size", "2mm", "-o", tmp_path / "c.vtu")
    assert made.returncode == DONE, made.stderr
    facts = json.loads(sinew("info", tmp_path / "c.vtu", "--json").stdout)
    assert facts["volume_m3"] == pytest.approx(np.pi * 0.005**2 * (0.02 + 4.0 / 3.0 * 0.005))


def test_convergence(scene, tmp_path):
    path = scene()
    result = sinew("convergence", path, "--levels", "2", "--json", tmp_path / "figures.json")
    assert result.returncode == DONE, result.stderr
    assert "error of the scene's mesh" in result.stdout
    first, second = json.loads((tmp_path / "figures.json").read_text())["levels"]
    assert first["elements"] == 240 < second["elements"]


def test_a_filled_surface_names_the_unit_of_its_file(tmp_path):
    if shutil.which("gmsh") is None:
        pytest.skip("without Gmsh")
    cube = ROOT / "tests" / "mesh" / "data_surface" / "cube_binary.stl"
    for unit, length in (("m", "1 m"), ("cm", "10 mm")):
        made = sinew("mesh", cube, "--unit", unit, "--size", f"0.05 {unit}", "-o", tmp_path / "cube.vtu")
        assert made.returncode == DONE, made.stderr
        assert f"1 file unit = {length}\n" in made.stdout and f"wrote {tmp_path / 'cube.vtu'}, lengths in m\n" in made.stdout


def test_mesh_and_info(tmp_path):
    made = sinew("mesh", "--shape", "block", "--size", "10mm", "-o", tmp_path / "b.vtu")
    assert made.returncode == DONE, made.stderr
    plain = sinew("info", tmp_path / "b.vtu")
    assert plain.returncode == DONE and "radius ratio" in plain.stdout
    facts = json.loads(sinew("info", tmp_path / "b.vtu", "--json").stdout)
    assert facts["volume_m3"] == pytest.approx(0.1 * 0.02 * 0.02)
    assert facts["nodes"] == 11 * 3 * 3 and facts["tetrahedra"] == 10 * 2 * 2 * 6
    assert sum(facts["radius_ratio"]["histogram"]["counts"]) == facts["tetrahedra"]
    assert facts["defects"] == []
    assert {"x_min", "x_max"} <= {s["name"] for s in facts["sets"]}


def test_info_reports_defects_and_does_not_fail(tmp_path):
    path = tmp_path / "flat.vtk"
    path.write_text("# vtk DataFile Version 3.0\nflat\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                    "POINTS 4 double\n0 0 0 1 0 0 0 1 0 1 1 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n")
    result = sinew("info", path, "--json")
    assert result.returncode == DONE, result.stderr
    assert [d["kind"] for d in json.loads(result.stdout)["defects"]] == ["zero-volume"]
    assert "zero" in sinew("info", path).stdout


def test_info_of_every_kind(scene, tmp_path):
    path = scene()
    assert sinew("run", path, "--out", tmp_path / "o").returncode == DONE
    run = json.loads(sinew("info", tmp_path / "o" / "run.h5", "--json").stdout)
    assert run["kind"] == "run" and run["frames"] == 11 and run["bodies"] == ["beam"]
    assert json.loads(sinew("info", tmp_path / "o", "--json").stdout) == run  # the folder of a run
    described = json.loads(sinew("info", path, "--json").stdout)
    assert described["kind"] == "scene" and described["bodies"][0]["mass_kg"] == pytest.approx(0.0428)
    stl = tmp_path / "t.stl"
    stl.write_text("solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                   "endloop\nendfacet\nendsolid t\n")
    surface = json.loads(sinew("info", stl, "--json", "--unit", "mm").stdout)
    assert surface["kind"] == "surface" and surface["closed"] is False and surface["triangles"] == 1
    cube = json.loads(sinew("info", ROOT / "tests" / "mesh" / "data_surface" / "cube_binary.stl", "--json").stdout)
    assert cube["closed"] is True and cube["triangles"] == 12 and "defect" not in cube
    size = cube["size_m"][0]
    assert abs(cube["volume_m3"] / size**3 - 1) < 1e-9
    assert abs(cube["inertia_m5"][1][1] / (size**5 / 6) - 1) < 1e-9 and len(cube["centre_m"]) == 3
    robot = json.loads(sinew("info", ROOT / "examples" / "rigid" / "urdf_arm.yaml", "--json").stdout)
    upper = next(body for body in robot["bodies"] if body["name"] == "arm.upper")
    assert upper["mass_kg"] == 0.5 and upper["closed"] is True and upper["triangles"] == 76
    assert abs(upper["centre_of_mass_m"][2] - 0.093) < 1e-12 and abs(upper["inertia_kg_m2"][0][0] - 0.0022) < 1e-12


def test_info_writes_few_digits(scene):
    path = scene(replace=("effectors:", """  air:
    type: chamber
    body: beam
    surface: {file: cavity.stl, unit: mm}
effectors:"""))
    low, high = np.array([20.0, 5.0, 5.0]), np.array([51.3, 12.7, 14.1])
    corners = [[(low, high)[(k >> axis) & 1][axis] for axis in range(3)] for k in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    meshio.Mesh(np.array(corners), [("triangle", np.array(faces))]).write(path.parent / "cavity.stl")
    told = sinew("info", path)
    assert told.returncode == DONE, told.stderr
    assert "chamber air, 2.193 ml in 12 faces" in told.stdout
    assert not re.search(r"\d{7}", told.stdout)


STAGES = ["assembly", "rows", "factorisation", "law", "correction", "total"]


def test_bench_writes_its_figures(scene, tmp_path):
    path = scene()
    path.write_text(path.read_text() + CONTROL)
    result = sinew("bench", path, "--steps", "25", "--threads", "2", "--json", tmp_path / "b.json",
                   "--compare-eigen", "--tangent", "projected", cwd=tmp_path)
    assert result.returncode == DONE, result.stderr
    figures = json.loads((tmp_path / "b.json").read_text())
    assert figures["steps"] == 25 and figures["threads"] == 2 and figures["machine"]
    assert figures["tangent"] == "projected"
    assert list(figures["stages"]) == STAGES
    for stage in figures["stages"].values():
        assert 0 <= stage["median_us"] <= stage["p95_us"]
    total = figures["stages"]["total"]["median_us"]
    assert total > figures["stages"]["assembly"]["median_us"] > 0
    eigen = figures["eigen_simplicial_ldlt"]
    assert eigen["ratio"] == pytest.approx(total / eigen["median_us"])
    assert figures["bytes_per_simulation"] > 1000
    assert "Eigen SimplicialLDLT" in result.stdout
    assert not (tmp_path / "out").exists(), "nothing is recorded"


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
    """Turns a recording into one of format 2."""
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
    assert not (out / "run.png").exists()  # it was of the former run
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


def test_validate_passes_cases_on(tmp_path):
    (tmp_path / "run.py").write_text("import sys\nprint(sys.argv[1:])\nsys.exit(3)\n")
    result = subprocess.run([os.path.abspath(PROGRAM), "validate", "patch", "--jobs", "2", "--list"],
                            capture_output=True, text=True, env={**os.environ, "SINEW_VALIDATION_DIR": str(tmp_path)}, check=False)
    assert result.returncode == 3
    assert result.stdout.strip() == "['--list', '--jobs=2', '--', 'patch']"
    nowhere = subprocess.run([os.path.abspath(PROGRAM), "validate"], capture_output=True, text=True,
                             env={**os.environ, "SINEW_VALIDATION_DIR": "/nowhere"}, check=False)
    assert nowhere.returncode == WRONG and "[tool-missing]" in nowhere.stderr


def test_validation_resumes_with_the_cases_that_have_not_ended(tmp_path):
    folder, runs = tmp_path / "validation", tmp_path / "runs"
    shutil.copytree(ROOT / "validation" / "suite", folder / "suite", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "validation" / "run.py", folder)
    (folder / "cases").mkdir()
    case = folder / "cases" / "circle.py"
    case.write_text('TITLE, SETUP, SOURCES = "Circle", "A circle.", {"Archimedes": "Measurement of a circle"}\n'
                    f'def run(case):\n    open("{runs}", "a").write("x")\n'
                    '    case.check("pi", 3.1416, 3.14159265, 1e-5, source="Archimedes")\n')

    def validate(*options):
        done = subprocess.run([os.path.abspath(PROGRAM), "validate", *options, "--out", str(tmp_path / "docs")], capture_output=True,
                              text=True, env={**os.environ, "SINEW_VALIDATION_DIR": str(folder)}, check=False)
        assert done.returncode == 0, done.stderr
        return len(runs.read_text()), (tmp_path / "docs" / "scorecard.md").read_text()

    assert validate()[0] == 1
    assert validate()[0] == 2
    count, card = validate("--resume")
    assert count == 2 and "1 passed, 0 missed" in card
    case.write_text(case.read_text().replace("3.1416", "3.14159"))
    assert validate("--resume")[0] == 3
    shutil.copy(case, folder / "cases" / "other.py")
    one = subprocess.run([os.path.abspath(PROGRAM), "validate", "circle", "--out", str(tmp_path / "docs")], capture_output=True,
                         text=True, env={**os.environ, "SINEW_VALIDATION_DIR": str(folder)}, check=False)
    assert "    passed: pi: 3.1416, reference 3.1416, error " in one.stdout, one.stdout
    assert f"scorecard.md is unchanged; the plots are in {tmp_path / 'docs' / 'images'}" in one.stdout


def test_elements_are_named_and_warned_of(scene, tmp_path):
    law = ("{model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}",
           "{model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.45}")
    short = ["--duration", "20ms", "--out", tmp_path / "o"]
    tacit = sinew("run", scene(replace=law), *short)
    assert tacit.returncode == DONE and tacit.stderr.count("\n") == 1, tacit.stderr
    assert tacit.stderr.startswith("sinew: warning: ") and "bodies.beam.material" in tacit.stderr
    assert "element: tet10" in tacit.stderr and "[locking-element]" in tacit.stderr
    assert " tet4 elements" in tacit.stdout
    chosen = scene(replace=(law[0], law[1] + "\n    element: tet4"))
    assert sinew("run", chosen, *short).stderr == ""
    told = sinew("info", chosen)
    assert "remark: " in told.stdout and "times too stiffly" in told.stdout
    facts = json.loads(sinew("info", chosen, "--json").stdout)
    assert facts["notices"][0]["level"] == "remark" and list(facts["bodies"][0]["elements"]) == ["tet4"]
    rubber = sinew("run", scene(replace=(law[0], "dragon-skin-30")), *short)
    assert rubber.returncode == DONE and " tet10 elements" in rubber.stdout
    # Its cable has bare points, which quadratic elements feel.
    assert rubber.stderr.count("\n") == 1 and rubber.stderr.rstrip().endswith("[bare-points]")
    assert "guide_radius: " in rubber.stderr


DESIGN = """\
sinew: 1
gravity: 0 0 0 m/s^2            # this slender trunk would buckle under its weight if it stood upright; hang robots along +z or -z
time_step: 10 ms
integrator: quasi-static        # quasi-static | backward-euler | bdf2 | {type: generalized-alpha, spectral_radius: 0.8}
bodies:
  trunk:
    type: fem
    mesh: {file: trunk.vtk, unit: mm}
    element: tet4               # tet4 | tet10 | hex8
    material: {model: corotational, young_modulus: 450 kPa, poisson_ratio: 0.45}   # or: material: ecoflex-00-30
    mass: 42 g                  # or density: 1070 kg/m^3
    damping: {mass: 0.1 1/s, stiffness: 0.01 s}
    fixed: [{box: -20 -20 0 20 20 20 mm}]
actuators:
  long_0:
    type: cable                 # cable | chamber | spring | force
    body: trunk
    points: {file: long_0.csv, unit: mm}      # or an inline list of "x y z mm"; the first is the pull point
    pull: world                               # world | body: what the pull point is fixed to
    outside: nearest                          # a via point outside the mesh: error (default) | nearest
    limits: {tension: {min: 0 N, max: 20 N}, displacement: {min: 0 mm, max: 70 mm, rate: 100 mm/s}}
    command: {displacement: 0 mm}             # or tension; a value or a signal: {ramp: ..} {sine: ..} {steps: ..} {file: pull.csv}
effectors:
  tip: {body: trunk, point: 0 0 195 mm}
controllers:
  follow:
    type: inverse
    effectors:
      tip: {target: {circle: {centre: 0 0 190 mm, radius: 30 mm, normal: 0 0 1, period: 10 s}}}
record: {every: 1, states: true}
"""


def write_vtk_in_millimetres(vtu, path):
    """A VTU of ours, in m, as legacy VTK in mm."""
    mesh = meshio.read(vtu)
    cells = mesh.cells_dict["tetra"]
    lines = ["# vtk DataFile Version 3.0", "trunk", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(mesh.points)} double"]
    lines += ["{:.17g} {:.17g} {:.17g}".format(*(1e3 * point)) for point in mesh.points]
    lines += [f"CELLS {len(cells)} {5 * len(cells)}"]
    lines += ["4 {} {} {} {}".format(*cell) for cell in cells]
    lines += [f"CELL_TYPES {len(cells)}", *["10"] * len(cells)]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def test_the_scene_of_the_documentation_runs_as_written(tmp_path):
    assert sinew("mesh", "--shape", "trunk", "-o", tmp_path / "trunk.vtu").returncode == DONE
    write_vtk_in_millimetres(tmp_path / "trunk.vtu", tmp_path / "trunk.vtk")
    shutil.copy(ROOT / "examples" / "trunk" / "long_0.csv", tmp_path)
    (tmp_path / "trunk.yaml").write_text(DESIGN, encoding="utf-8")
    result = sinew("run", "trunk.yaml", cwd=tmp_path)
    assert result.returncode == DONE, result.stderr
    with open(tmp_path / "out" / "trunk" / "run.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 1001  # one turn of the circle
    tension = np.array([float(row["long_0.tension [N]"]) for row in rows])
    pulled = np.array([float(row["long_0.displacement [m]"]) for row in rows])
    assert tension.min() >= 0 and tension.max() > 0.05
    assert pulled.max() <= 0.070 + 1e-9 and np.abs(np.diff(pulled)).max() <= 0.1 * 0.01 + 1e-9
    with h5py.File(tmp_path / "out" / "trunk" / "run.h5") as file:
        assert file["positions/trunk"].shape == (1001, 703, 3)
