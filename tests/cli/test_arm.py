"""sinew reach, plan, brace and identify as programs, compared with the Python package.

    SINEW_PROGRAM=build/release/bin/sinew /usr/bin/python3 -m pytest tests/cli
"""

import json

import numpy as np
import pytest
from program import DONE, FAILED, ROOT, WRONG, rows_of, sinew

ARM = ROOT / "examples" / "fluidic_arm" / "arm.yaml"
TORQUES = [0.12, 0.13, 0.18]  # N m, as in the scene
ACTUATION = np.vstack([np.zeros(3), np.eye(3)])  # its first segment has no actuator


def needs(command):
    if "Not available" in sinew(command, "--help").stdout:
        pytest.skip(f"built without what `sinew {command}` needs")


def module(name):
    return pytest.importorskip(f"sinew.{name}")


def scene_arm(masses=(0.19, 0.146, 0.09, 0.09), stiffness=0.108, damping=4.2e-3, actuation=ACTUATION):
    return module("pcc").Arm([0.14] * 4, masses, stiffness, damping, actuation=actuation)


def edited(tmp_path, *edits, name="arm.yaml"):
    """The example with some of its text replaced."""
    text = ARM.read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path / name


def test_reach_tells_what_python_does(tmp_path):
    needs("reach")
    plan = module("plan")
    goal = [0.20, 0.0, -0.40]
    done = sinew("reach", ARM, "--samples", "60", "--seed", "3", "--goal", "20 0 -40 cm", "--goal", "0 0 -56 cm",
                 "--json", "reach.json", "-o", "reach.csv", "--plot", "reach.png", cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    assert done.stderr == "", "no progress bar unless there is a terminal"
    told = json.loads((tmp_path / "reach.json").read_text())
    arm = scene_arm()
    map_ = plan.sample_reach(arm, TORQUES, 60, 3)
    np.testing.assert_allclose(told["tip_m"], map_["tip"], atol=1e-9)
    far, straight = told["goals"]
    nearest = plan.nearest_reach(arm, TORQUES, goal)
    assert far["distance_m"] == pytest.approx(nearest["distance"], rel=1e-6) and far["distance_m"] > 0.05
    np.testing.assert_allclose(far["tip_m"], nearest["tip"], atol=1e-6)
    assert far["proof"] == plan.prove_out_of_reach(arm, TORQUES, goal)["verdict"] == "out-of-reach"
    assert straight["proof"] == "reachable" and straight["distance_m"] < 1e-4
    assert "out-of-reach" in done.stdout and "reachable" in done.stdout
    rows = rows_of(tmp_path / "reach.csv")
    assert len(rows) == len(map_["tip"]) > 60
    assert float(rows[5]["z [m]"]) == pytest.approx(map_["tip"][5, 2], abs=1e-9)
    assert float(rows[5]["fourth [N m]"]) == pytest.approx(map_["torque"][5, 2], abs=1e-12)
    assert (tmp_path / "reach.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("step_ms", [2, 1])
def test_a_planned_motion_runs_to_its_goal(tmp_path, step_ms):
    needs("plan")
    plan = module("plan")
    goal = np.array([0.20, 0.0, -0.40])
    done = sinew("plan", ARM, "--goal", "20 0 -40 cm", "--rate-limit", "2Nm/s", "--seed", "1", "-o", "plan.csv",
                 "--json", "plan.json", "--plot", "plan.png", cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    assert done.stderr == "" and "solved" in done.stdout
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    told = json.loads((tmp_path / "plan.json").read_text())
    task = plan.Task(scene_arm(), goal, TORQUES, torque_rate_limits=2.0)
    found = task.solve(1)
    replay = task.replay(found)
    np.testing.assert_allclose(told["torque_N_m"], found.torque, atol=1e-6)
    assert told["tip_error_m"] == pytest.approx(replay.tip_error, abs=1e-5)
    assert told["tip_speed_m_s"] == pytest.approx(replay.tip_speed, abs=1e-4)
    rows = rows_of(tmp_path / "plan.csv")
    assert list(rows[0]) == ["time [s]", "second [N m]", "third [N m]", "fourth [N m]"]
    torque = np.array([[float(cell) for cell in row.values()] for row in rows])
    assert np.all(np.abs(torque[:, 1:]) <= np.array(TORQUES) + 1e-6)
    assert np.abs(np.diff(torque[:, 1:], axis=0) / np.diff(torque[:, 0])[:, None]).max() < 2.0 + 1e-4
    # Uses the options printed by the command, with the time step of the scene.
    words = [word.strip(" '\\") for word in done.stdout.split("--set")[1:]]
    run = sinew("run", ARM, "--duration", "1.6s", "--out", "out", "--quiet", "--set", f"time_step={step_ms}ms",
                *[word for value in words for word in ("--set", value.splitlines()[0].strip(" '\\"))], cwd=tmp_path)
    assert run.returncode == DONE, run.stderr
    last = rows_of(tmp_path / "out" / "run.csv")[-1]
    tip = np.array([float(last[f"tip.{axis} [m]"]) for axis in "xyz"])
    assert float(last["time [s]"]) == pytest.approx(1.6)
    # Both are of second order; the replay has steps of 1 ms.
    assert np.linalg.norm(tip - replay.tip[-1]) < 1e-5 * step_ms**2
    assert np.linalg.norm(tip - goal) < 2.2e-3


def test_a_free_duration_and_tolerances(tmp_path):
    needs("plan")
    done = sinew("plan", ARM, "--goal", "20 0 -40 cm", "--free-duration", "--tolerance", "1cm", "--speed-tolerance",
                 "2cm/s", "--json", "plan.json", cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    told = json.loads((tmp_path / "plan.json").read_text())
    assert 0.8 <= told["times_s"][-1] <= 3.2
    assert told["starts"][0]["duration_s"] == pytest.approx(told["times_s"][-1])


def test_bad_options_of_plans():
    needs("plan")
    for arguments, words in ((["--rate-limit", "2N"], ["--rate-limit", "'2N'", "2Nm/s", "wrong-dimension"]),
                             (["--duration", "-1s"], ["--duration", "not positive"]),
                             (["--method", "euler"], ["'euler'", "backward-euler", "unknown-choice"]),
                             (["--seeds", "0"], ["--seeds", "out-of-range"])):
        wrong = sinew("plan", ARM, "--goal", "20 0 -40 cm", *arguments)
        assert wrong.returncode == WRONG and all(word in wrong.stderr for word in words), wrong.stderr


def test_what_cannot_be_planned_fails_with_its_status(tmp_path):
    needs("plan")
    done = sinew("plan", ARM, "--goal", "-30 0 -30 cm", "--duration", "100ms", "-o", "plan.csv", cwd=tmp_path)
    assert done.returncode == FAILED
    assert "not-converged" in done.stderr and "--duration" in done.stderr
    assert "infeasible" in done.stdout and "infeasible" in done.stderr
    assert not (tmp_path / "plan.csv").exists()


BAR = ARM.with_name("brace.yaml")


def test_brace_leans_on_the_scenes_contacts(tmp_path):
    needs("brace")
    done = sinew("brace", BAR, "--goal", "5 0 -53 cm", "--segment", "4", "--disturbances", "2", "--duration", "0.5s",
                 "--friction", "silicone-on-steel", "-o", "run.csv", "--json", "brace.json", "--plot", "brace.png",
                 cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    assert done.stderr == "" and "ignored: " not in done.stdout
    for word in ("braced: segment 4", "'bar'", "friction", "stiffness", "kinematic", "holds", "held"):
        assert word in done.stdout, (word, done.stdout)
    assert (tmp_path / "brace.png").read_bytes().startswith(b"\x89PNG")
    told = json.loads((tmp_path / "brace.json").read_text())
    assert told["status"] == "braced" and told["object"] == "bar"
    tip = scene_arm().endpoints(np.array(told["angle_rad"]))[-1]
    assert np.linalg.norm(tip - [0.05, 0.0, -0.53]) < 2e-3
    assert np.all(np.abs(told["torque_N_m"]) <= np.array(TORQUES) + 1e-6)
    assert np.linalg.norm(np.array(told["place_m"])[[0, 2]] - [-0.077, -0.445]) == pytest.approx(0.05, abs=1e-6)
    assert told["hold_force_N"] > 0.04 and told["friction_force_N"] < 0.6 * told["normal_force_N"]
    assert [c["verdict"] for c in told["conditions"]] == ["holds"] * 3
    assert [run["seed"] for run in told["runs"]] == [1, 2]
    for run in told["runs"]:
        assert run["status"] == "held" and run["slips"] == 0
        assert run["spread_m"] < run["not_braced_spread_m"]
    rows = rows_of(tmp_path / "run.csv")
    assert list(rows[0]) == ["time [s]", "tip.x [m]", "tip.y [m]", "tip.z [m]", *[f"angle_{k} [rad]" for k in range(4)],
                             *[f"{name} [N m]" for name in ("second", "third", "fourth")], "normal_force [N]",
                             "friction_force [N]"]
    last = rows[-1]
    assert float(last["time [s]"]) == pytest.approx(5.0)
    assert np.linalg.norm([float(last[f"tip.{x} [m]"]) - goal for x, goal in zip("xyz", (0.05, 0.0, -0.53))]) < 5e-3
    assert float(last["friction_force [N]"]) <= 0.6 * float(last["normal_force [N]"]) + 1e-9


def test_a_brace_that_cannot_be_fails_with_its_status(tmp_path):
    needs("brace")
    bare = sinew("brace", ARM, "--goal", "5 0 -53 cm", "--json", "brace.json", cwd=tmp_path)
    assert bare.returncode == FAILED
    assert "infeasible" in bare.stdout and "no contact of 'arm'" in bare.stderr and "contacts:" in bare.stderr
    assert json.loads((tmp_path / "brace.json").read_text())["status"] == "infeasible"
    slippery = sinew("brace", BAR, "--goal", "5 0 -53 cm", "--segment", "4", "--friction", "coated-rigid", "-o",
                     "run.csv", cwd=tmp_path)
    assert slippery.returncode == FAILED
    assert "violated" in slippery.stdout and "not-converged" in slippery.stderr
    assert not (tmp_path / "run.csv").exists()
    far = sinew("brace", BAR, "--goal", "5 0 -53 cm", "--set",
                "contacts.bar.surface.capsule.ends=[-2 -0.1 -0.4 m, -2 0.1 -0.4 m]")
    assert far.returncode == FAILED and "no-object-in-reach" in far.stdout


def test_bad_options_of_braces(tmp_path):
    needs("brace")
    moving = BAR.read_text(encoding="utf-8").replace("    outside: nearest\n",
                                                     "    outside: nearest\n    motion: {z: 1 mm}\n")
    (tmp_path / "moving.yaml").write_text(moving, encoding="utf-8")
    for scene, arguments, words in (
            (BAR, ["--friction", "ice"], ["'ice'", "coated-rigid", "unknown-choice"]),
            (BAR, ["--friction", "0.5 0.2"], ["0.5 to 0.2", "out-of-range"]),
            (BAR, ["--friction", "1 2 3"], ["--friction", "wrong-length"]),
            (BAR, ["--hold-force", "0.04 m"], ["--hold-force", "wrong-dimension"]),
            (BAR, ["--tolerance", "-1mm"], ["--tolerance", "not positive"]),
            (BAR, ["--segment", "5"], ["--segment", "out-of-range"]),
            (BAR, ["--disturbances", "0"], ["--disturbances", "out-of-range"]),
            (tmp_path / "moving.yaml", [], ["contacts.bar.motion", "moving surface"])):
        wrong = sinew("brace", scene, "--goal", "5 0 -53 cm", *arguments)
        assert wrong.returncode == WRONG, (arguments, wrong.stdout)
        assert all(word in wrong.stderr for word in words), wrong.stderr


@pytest.mark.parametrize("command", ["brace", "plan", "reach"])
def test_bad_goals_limits_and_bodies(tmp_path, command):
    needs(command)
    crossed = edited(tmp_path, ("{min: -0.12 N m, max: 0.12 N m}", "{min: 0.12 N m, max: -0.12 N m}"))
    beam = ROOT / "examples" / "beam" / "swing.yaml"
    for scene, goal, more, words in (
            (ARM, "0 0 -57 cm", [], ["goal", "0.57 m", "0.56 m", "out-of-range"]),
            (ARM, "20 0 cm", [], ["--goal", "wrong-length"]),
            (ARM, "20 0 -40 kg", [], ["--goal", "wrong-dimension"]),
            (crossed, "20 0 -40 cm", [], ["limits", "contradictory-limits"]),
            (beam, "20 0 -40 cm", [], ["no arm", "type pcc", "wrong-type"]),
            (ARM, "20 0 -40 cm", ["--body", "amr"], ["did you mean 'arm'?", "unknown-name"]),
            (ARM, "20 0 -40 cm", ["--set", "bodies.arm.segments.1.mass=-1 g"], ["-1 g", "out-of-range"])):
        wrong = sinew(command, scene, "--goal", goal, *more)
        assert wrong.returncode == WRONG, (goal, more, wrong.stdout)
        for word in words:
            assert word in wrong.stderr, (word, wrong.stderr)


def test_reach_wants_limits(tmp_path):
    needs("reach")
    free = edited(tmp_path, ("    limits: {torque: {min: -0.13 N m, max: 0.13 N m}}\n", ""))
    wrong = sinew("reach", free)
    assert wrong.returncode == WRONG and "actuators.third" in wrong.stderr and "limits:" in wrong.stderr


@pytest.fixture(name="takes", scope="module")
def record_takes(tmp_path_factory):
    """Two records of a driven arm with other masses, stiffness and damping than the scene."""
    needs("identify")
    identify = module("identify")
    folder = tmp_path_factory.mktemp("takes")
    truth = scene_arm((0.21, 0.135, 0.1, 0.085), 0.115, 3.6e-3)
    for seed in (1, 2):
        random = np.random.default_rng(seed)
        time = np.arange(0.0, 3.0001, 0.02)
        frequency, phase = random.uniform(2, 8, (2, 3)), random.uniform(0, 6, (2, 3))
        torque = 0.04 * sum(np.sin(np.outer(time, f) + p) for f, p in zip(frequency, phase))
        torque *= np.clip(2 * time, 0, 1)[:, None]
        ends = identify.predict_motion(truth, time, np.zeros(4), inputs=torque, time_step=2e-3)
        ends += 3e-4 * random.standard_normal(ends.shape)
        ends[random.random(ends.shape[:2]) < 0.02] = np.nan
        names = ["time [s]"] + [f"{axis}_{k} [mm]" for k in range(4) for axis in "xz"]
        names += [f"torque_{k} [N m]" for k in range(3)]
        table = np.column_stack([time, 1e3 * ends[:, :, [0, 2]].reshape(len(time), -1), torque])
        cells = [",".join("" if np.isnan(x) else f"{x:.9g}" for x in row) for row in table]
        (folder / f"take_{seed}.csv").write_text("\n".join([",".join(names), *cells]) + "\n")
    return folder


def test_identify_finds_what_python_does(takes, tmp_path):
    identify = module("identify")
    done = sinew("identify", ARM, takes / "take_1.csv", "--fixed", "mass_0", "--set", "bodies.arm.segments.0.mass=210g",
                 "--validate", takes / "take_2.csv", "--json", "arm.json", "-o", "found.yaml", "--plot", "arm.png",
                 cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    assert done.stderr == ""
    told = json.loads((tmp_path / "arm.json").read_text())
    start = scene_arm((0.21, 0.146, 0.09, 0.09))
    record = identify.read_motion(takes / "take_1.csv", segments=4)
    found = identify.fit_arm(start, [record], fixed=["mass_0"])
    truth = {"mass_0": 0.21, "mass_1": 0.135, "mass_2": 0.1, "mass_3": 0.085, "stiffness": 0.115, "damping": 3.6e-3}
    assert [one["name"] for one in told["parameters"]] == list(truth)
    for one in told["parameters"]:
        assert one["value"] == pytest.approx(found.fit.values[one["name"]], rel=1e-6)
        assert one["name"] in done.stdout
        assert one["value"] == pytest.approx(truth[one["name"]], rel=0.03)
    assert told["parameters"][0]["fixed"] and "interval" not in told["parameters"][0]
    assert told["undetermined"] == found.undetermined == 0
    checked = identify.validate_arm(found, [identify.read_motion(takes / "take_2.csv", segments=4)])[0]
    assert told["validated"][0]["nrmse"] == pytest.approx(checked.nrmse, rel=1e-4)
    assert checked.nrmse < 0.05
    assert (tmp_path / "arm.png").read_bytes().startswith(b"\x89PNG")
    info = json.loads(sinew("info", "found.yaml", "--json", cwd=tmp_path).stdout)
    assert info["bodies"][0]["mass_kg"] == pytest.approx(sum(p["value"] for p in told["parameters"][:4]), rel=1e-9)
    # The written scene contains the values: another fit does not change them.
    again = sinew("identify", "found.yaml", takes / "take_1.csv", "--fixed", "mass_0", "--json", "again.json",
                  cwd=tmp_path)
    assert again.returncode == DONE, again.stderr
    for one, other in zip(told["parameters"], json.loads((tmp_path / "again.json").read_text())["parameters"]):
        assert other["value"] == pytest.approx(one["value"], rel=1e-4)
    assert sinew("run", "found.yaml", "--duration", "20ms", "--quiet", "--out", "out", cwd=tmp_path).returncode == DONE


def test_a_passive_arm_shows_the_scale_that_motion_leaves_open(tmp_path):
    needs("identify")
    identify = module("identify")
    truth = scene_arm((0.21, 0.135, 0.1, 0.085), 0.115, 3.6e-3)
    time = np.arange(0.0, 2.0, 0.02)
    ends = identify.predict_motion(truth, time, np.array([0.3, 0.5, -0.4, 0.8]), time_step=2e-3)
    ends += 3e-4 * np.random.default_rng(1).standard_normal(ends.shape)
    names = ["time [s]"] + [f"{axis}_{k} [m]" for k in range(4) for axis in "xyz"]
    np.savetxt(tmp_path / "let_go.csv", np.column_stack([time, ends.reshape(len(time), 12)]), delimiter=",",
               header=",".join(names), comments="")
    done = sinew("identify", ARM, "let_go.csv", "--passive", "--json", "arm.json", cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    assert "not determined by the data" in done.stdout and "fix one of them" in done.stdout
    assert json.loads((tmp_path / "arm.json").read_text())["undetermined"] == 1
    asked = sinew("identify", ARM, "let_go.csv", cwd=tmp_path)
    assert asked.returncode == WRONG and "--passive" in asked.stderr and "wrong-columns" in asked.stderr


def test_identify_finds_actuators_driven_by_volumes(tmp_path):
    needs("identify")
    identify, pcc = module("identify"), module("pcc")
    time = np.arange(0.0, 5.0, 0.02)
    fade = np.sin(np.pi * np.clip(time, 0, 0.5)) ** 2
    volumes = np.stack([fade * pcc.Excitation(3e-5, seed=k).at(time) for k in range(3)], axis=1)
    ends = identify.predict_motion(scene_arm(), time, np.zeros(4), inputs=volumes,
                                   actuators=[pcc.FluidicActuator(4e12, delay=0.08)] * 3, time_step=2e-3)
    ends += 3e-4 * np.random.default_rng(1).standard_normal(ends.shape)
    names = ["time [s]"] + [f"{axis}_{k} [m]" for k in range(4) for axis in "xyz"]
    names += [f"volume_{k} [ml]" for k in range(3)]
    np.savetxt(tmp_path / "take.csv", np.column_stack([time, ends.reshape(len(time), 12), 1e6 * volumes]),
               delimiter=",", header=",".join(names), comments="")
    done = sinew("identify", ARM, "take.csv", "--coefficient", "2.8e12", "--delay", "20ms", "--fixed",
                 "mass_0,mass_1", "--json", "arm.json", "-o", "found.yaml", cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    found = {one["name"]: one for one in json.loads((tmp_path / "arm.json").read_text())["parameters"]}
    assert found["mass_0"]["fixed"] and found["mass_1"]["fixed"] and not found["mass_2"]["fixed"]
    for k in range(3):
        assert found[f"coefficient_{k}"]["value"] == pytest.approx(4e12, rel=0.03)
    assert found["delay"]["value"] == pytest.approx(0.08, abs=1e-3)
    # A scene cannot contain actuators driven by volumes, so the identified law is a comment in the written scene.
    assert "second: torque =" in (tmp_path / "found.yaml").read_text()


def test_bad_records(takes, tmp_path):
    lines = (takes / "take_1.csv").read_text().splitlines()
    swapped = lines[:5] + [lines[6], lines[5]] + lines[7:]
    for name, rows, words in (("short", lines[:6], ["short", "too-few-points"]),
                              ("back", swapped, ["0.08 s", "non-monotonic-time"]),
                              ("volumes", [lines[0].replace("torque", "volume").replace("N m", "ml"), *lines[1:]],
                               ["--coefficient", "bad-argument"])):
        (tmp_path / f"{name}.csv").write_text("\n".join(rows) + "\n")
        wrong = sinew("identify", ARM, f"{name}.csv", "-o", "found.yaml", cwd=tmp_path)
        assert wrong.returncode == WRONG, wrong.stdout
        for word in words:
            assert word in wrong.stderr, (word, wrong.stderr)
    for arguments, words in (
            ([ARM, takes / "take_1.csv", "--fixed", "mas_1"], ["did you mean 'mass_1'?", "unknown-name"]),
            ([ARM, takes / "none.csv"], ["file-not-found"]),
            ([ROOT / "examples" / "beam" / "swing.yaml", takes / "take_1.csv"], ["type pcc", "wrong-type"]),
            ([ARM, takes / "take_1.csv", "--damping", "5e-3 1e-3 N m s"], ["damping", "contradictory-limits"])):
        wrong = sinew("identify", *arguments, "-o", "found.yaml", cwd=tmp_path)
        assert wrong.returncode == WRONG, wrong.stdout
        for word in words:
            assert word in wrong.stderr, (word, wrong.stderr)
    assert not (tmp_path / "found.yaml").exists()


def test_signals_read_columns_by_name(tmp_path):
    (tmp_path / "pull.csv").write_text("time [s],other [N m],second [mN m]\n0,1,0\n1,1,50\n")
    command = "{torque: {sine: {amplitude: 0.10 N m, period: 1.4 s}}}"
    scene = edited(tmp_path, (f"max: 0.12 N m}}}}\n    command: {command}",
                              "max: 0.12 N m}}\n    command: {torque: {file: pull.csv, column: second}}"))
    done = sinew("run", scene, "--duration", "0.5s", "--quiet", "--out", "out", cwd=tmp_path)
    assert done.returncode == DONE, done.stderr
    last = rows_of(tmp_path / "out" / "run.csv")[-1]
    for name in ("second.torque [N m]", "second.torque_command [N m]"):
        assert float(last[name]) == pytest.approx(0.025, abs=1e-9), "the heading's unit holds"
    missing = sinew("run", scene, "--quiet", "--set", "actuators.second.command.torque={file: pull.csv, column: secnd}")
    assert missing.returncode == WRONG and "second [mN m]" in missing.stderr and "wrong-columns" in missing.stderr
