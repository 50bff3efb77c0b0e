"""sinew run as a program: recordings, pictures and files.

    SINEW_PROGRAM=build/release/bin/sinew /usr/bin/python3 -m pytest tests/cli
"""

import csv
import json
import re
import shutil

import h5py
import meshio
import numpy as np
import pytest
from program import CONTROL, DONE, FAILED, ROOT, WRONG, rows_of, sinew


def test_torques_are_in_newton_metres(tmp_path):
    result = sinew("run", ROOT / "examples" / "rigid" / "slider_crank.yaml", "--duration", "0.01s", "--out", tmp_path / "out")
    assert result.returncode == DONE, result.stderr
    assert re.search(r"^peak torque +0\.1[0-9]* N m of motor at ", result.stdout, re.MULTILINE), result.stdout


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
    failed = sinew("run", trunk, *pull, *rough, "--out", "rough", cwd=tmp_path)
    assert failed.returncode == FAILED
    assert "one linearisation leaves" in failed.stderr and "solver: newton" in failed.stderr
    rows = rows_of(tmp_path / "rough" / "run.csv")
    assert rows[0]["status"] == "start" and {row["status"] for row in rows[1:]} <= {"solved"} and len(rows) < 151
    told = sinew("run", trunk, *pull, *rough, "--keep-going", "--out", "rough", cwd=tmp_path)
    assert told.returncode == DONE
    assert "steps are not-in-equilibrium, the first at t = " in told.stderr
    rows = rows_of(tmp_path / "rough" / "run.csv")
    assert len(rows) == 151
    first = [row["status"] for row in rows].index("not-in-equilibrium")
    assert not {"solved", "start"} & {row["status"] for row in rows[first:]}, "what descends from a failed step is not solved"


BALLOON = """
sinew: 1
time_step: 50 ms
bodies:
  tube:
    type: fem
    mesh: {shape: hollow-cylinder, inner_radius: 10 mm, outer_radius: 13 mm, height: 30 mm, element_size: 5 mm}
    element: hex8
    material: {model: neo-hookean, young_modulus: 90 kPa, poisson_ratio: 0.45}
    fixed: [{set: bottom}, {set: top}]
actuators:
  air:
    type: chamber
    body: tube
    surface: {set: inner}
    cap: true
    command: {pressure: {ramp: {to: 60 kPa, duration: 1 s}}}
"""


def test_a_step_that_fails_ends_the_run_and_its_record(tmp_path):
    (tmp_path / "balloon.yaml").write_text(BALLOON)
    stopped = sinew("run", "balloon.yaml", "--out", "out", cwd=tmp_path)
    assert stopped.returncode == FAILED
    assert "limit point" in stopped.stderr and "volume_growth" in stopped.stderr
    rows = rows_of(tmp_path / "out" / "run.csv")
    assert {row["status"] for row in rows} == {"start", "solved"} and 1 < len(rows) < 21
    for row in rows:
        assert abs(float(row["air.pressure [Pa]"]) - 60e3 * float(row["time [s]"])) < 1.0
        assert float(row["air.volume_growth [m^3]"]) < 1e-3
    with h5py.File(tmp_path / "out" / "run.h5") as file:
        assert len(file["time"]) == len(rows)
    below = sinew("run", "balloon.yaml", "--set", "actuators.air.command.pressure.ramp.to=-150kPa", cwd=tmp_path)
    assert below.returncode == WRONG and "below vacuum" in below.stderr


def test_a_volume_that_needs_less_than_vacuum_is_named(tmp_path):
    """Steps that say `cavitates` are flagged, in the table, the summary and a warning; the run goes on to its end."""
    (tmp_path / "tube.yaml").write_text(BALLOON.replace("90 kPa", "20 MPa").replace("inner_radius: 10 mm", "inner_radius: 6 mm")
                                        .replace("pressure: {ramp: {to: 60 kPa", "volume_growth: {ramp: {to: -0.06 ml"))
    for more, code in (([], FAILED), (["--keep-going"], DONE), (["--set", "actuators.air.ambient_pressure=2bar"], DONE)):
        result = sinew("run", "tube.yaml", *more, "--out", "out", cwd=tmp_path)
        assert result.returncode == code, result.stderr
        rows = rows_of(tmp_path / "out" / "run.csv")[1:]
        below = [float(row["air.pressure [Pa]"]) < (-2e5 if "2bar" in str(more) else -101325) for row in rows]
        assert [row["status"] for row in rows] == ["cavitates" if one else "solved" for one in below]
        assert len(rows) == 20 and 1 < sum(below) < 10 or "2bar" in str(more) and not any(below)
        told = re.search(r"warning: (\d+) of 20 steps are cavitates, the first at t = (\S+) s; .*`ambient_pressure`", result.stderr)
        assert (told is not None) == any(below)
        if told:
            assert int(told[1]) == sum(below) and float(told[2]) == pytest.approx(0.05 * (below.index(True) + 1))
            assert re.search(rf"^steps cavitates +{sum(below)}$", result.stdout, re.MULTILINE), result.stdout


COLUMN = """
sinew: 1
gravity: 0 0 -9.81 m/s^2
time_step: 10 ms
duration: 20 ms
bodies:
  column:
    type: fem
    mesh: {shape: block, length: 18 mm, width: 18 mm, height: 100 mm, element_size: 18 mm}
    material: ecoflex-00-30
    pose: {position: -9 -9 0 mm}
    fixed: [{set: z_min}]
  block: {type: rigid, shape: {box: 18 18 18 mm}, mass: 20 g, pose: {position: 0 0 109 mm}}
joints:
  top: {type: weld, bodies: [column, block], points: ["0 0 100 mm", "4.5 0 100 mm", "0 4.5 100 mm"], outside: nearest}
"""


@pytest.mark.parametrize("which", ["converged", "following", "one linearisation", "dynamic", "snapped"])
def test_the_summary_tells_the_largest_residual_and_distance_and_the_steps_that_snapped(scene, tmp_path, which):
    """They are those of run.csv."""
    more = {"following": CONTROL, "one linearisation": "solver: one-linearisation", "dynamic": "integrator: bdf2"}
    (tmp_path / "column.yaml").write_text(COLUMN)
    result = sinew("run", tmp_path / "column.yaml" if which == "snapped" else scene(more.get(which, "")), "--out", tmp_path / "o",
                   *(["--set", "time_step=1ms"] if which == "one linearisation" else []))
    assert result.returncode == DONE, result.stderr
    told = dict(re.findall(r"^(\S.*?) {2,}(\S.*)$", result.stdout, re.MULTILINE))
    rows = rows_of(tmp_path / "o" / "run.csv")[1:]
    residuals, distances, snaps = (np.array([float(row[name]) for row in rows]) for name in ("relative_residual", "distance [m]", "snapped"))
    assert float(told["largest relative residual"]) == pytest.approx(residuals.max(), rel=0.06) and residuals.max() > 0
    number, unit, *how = told["largest distance to the solution"].split(maxsplit=2)
    assert unit == "mm" and float(number) == pytest.approx(1e3 * np.nanmax(distances), rel=0.06)  # of two digits; nan: not bounded
    assert how == {"following": ["(equilibrium: following)"], "one linearisation": ["(one linearisation)"]}.get(which, [])
    assert residuals.max() <= {"converged": 1e-6, "snapped": 1e-6, "dynamic": 1e-8}.get(which, 0.1)
    assert snaps.sum() == (which == "snapped")
    assert told.get("steps that snapped to another branch") == ("1" if which == "snapped" else None)
    # A snap is no flag.
    assert {row["status"] for row in rows} == ({"solved"})
    assert which == "following" or told["steps solved"] == str(len(rows))


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
    # Backward Euler loses energy, less with a smaller step, and never gains any.
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
    assert "displacement" not in last.point_data  # ParaView's Warp By Vector would add it twice
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

    # Thirty frames per second with steps of 10 ms: frames at 0, 40, 80, 120, 160 and 200 ms.
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


def test_rubber_takes_the_exact_tangent_in_place_of_the_rotated_one(scene, tmp_path):
    soft = ["--set", "solver.tangent=corotated", "--set", "bodies.beam.material.model=neo-hookean", "--duration", "0.05s"]
    told = sinew("run", scene(), *soft, "--out", "o", cwd=tmp_path)
    assert told.returncode == DONE and "'beam' has no corotated tangent" in told.stderr
    assert told.stderr.rstrip().endswith("[other-tangent]") and told.stderr.count("\n") == 1
    iterations = [float(row["iterations"]) for row in rows_of(tmp_path / "o" / "run.csv")]
    assert max(iterations) <= 6
    plain = sinew("run", scene(), "--set", "solver.tangent=corotated", "--duration", "0.05s", "--out", "p", cwd=tmp_path)
    assert plain.stderr == ""


def test_elements_are_named_and_warned_of(scene, tmp_path):
    law = ("element: tet4\n    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}",
           "material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.3}")
    short = ["--duration", "20ms", "--out", tmp_path / "o"]
    tacit = sinew("run", scene(replace=law), *short)
    assert tacit.returncode == DONE and tacit.stderr.count("\n") == 1, tacit.stderr
    assert tacit.stderr.startswith("sinew: warning: ") and "bodies.beam.material" in tacit.stderr
    assert "element: tet10" in tacit.stderr and "[locking-element]" in tacit.stderr
    assert " tet4 elements" in tacit.stdout
    chosen = scene(replace=(law[0], law[1] + "\n    element: tet4"))
    assert sinew("run", chosen, *short).stderr == ""
    told = sinew("info", chosen)
    assert "remark: " in told.stdout and "times too stiff" in told.stdout
    facts = json.loads(sinew("info", chosen, "--json").stdout)
    assert facts["notices"][0]["level"] == "remark" and list(facts["bodies"][0]["elements"]) == ["tet4"]
    rubber = sinew("run", scene(replace=(law[0], "material: {name: dragon-skin-30, scale: 1.2}")), *short)
    assert rubber.returncode == DONE and " tet10 elements" in rubber.stdout
    # Its cable has bare points, which matter for quadratic elements.
    assert rubber.stderr.count("\n") == 1 and rubber.stderr.rstrip().endswith("[bare-points]")
    assert "guide_radius: " in rubber.stderr


def test_laws_are_warned_of_at_load_and_where_strains_stay_small(scene, tmp_path):
    law = "element: tet4\n    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}"
    short = ["--duration", "20ms", "--out", tmp_path / "o"]

    def lines(material):
        done = sinew("run", scene(replace=(law, f"element: hex8\n    material: {material}")), *short)
        return [line for line in done.stderr.splitlines() if "[unstable-law]" in line or "[strain-range]" in line]

    (small,) = lines("dragon-skin-10-tensile")
    assert "bodies.beam.material: the largest strain is " in small and "write dragon-skin-10," in small
    assert lines("dragon-skin-10") == []
    (unstable,) = lines("ecoflex-00-50-published")
    assert "above 1.13 and below 0.885 in uniaxial stretch" in unstable and "write ecoflex-00-50 [" in unstable
    told = sinew("info", scene(replace=(law, "material: dragon-skin-10-tensile")))
    assert "tested stretch 1 to 4, error 15 % above 1.5" in told.stdout and "remark: " in told.stdout
    assert "is too soft where no stretch exceeds 2" in told.stdout


def test_the_library_is_printed():
    table = sinew("materials")
    assert table.returncode == DONE
    (row,) = [line.split() for line in table.stdout.splitlines() if line.startswith("ecoflex-00-50-published ")]
    assert row[-1] == "unstable" and "152.7" in row
    one = sinew("materials", "dragon-skin-10")
    assert "0.9 to 2" in one.stdout and "11 %" in one.stdout and "Dubied" in one.stdout
    wrong = sinew("materials", "dragon-skin-11")
    assert wrong.returncode == WRONG and "did you mean 'dragon-skin-10'?" in wrong.stderr


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
    """Converts a VTU of Sinew, in m, to legacy VTK in mm."""
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
