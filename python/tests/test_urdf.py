"""Robots from URDF files, compared with the same robots written in the scene."""

import warnings

import numpy as np
import pytest
import sinew
import solids
from scipy.spatial.transform import Rotation

GRAVITY = "0 0 -9.81 m/s^2"


def inertial(mass, moments, xyz="0 0 0", rpy="0 0 0"):
    x, y, z = moments
    return (f'<inertial><origin xyz="{xyz}" rpy="{rpy}"/><mass value="{mass}"/>'
            f'<inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0" iyz="0"/></inertial>')


def box(edges, xyz="0 0 0", rpy="0 0 0", kind="collision"):
    return f'<{kind}><origin xyz="{xyz}" rpy="{rpy}"/><geometry><box size="{edges}"/></geometry></{kind}>'


def link(name, *parts):
    return f'<link name="{name}">\n{"".join(parts)}\n</link>\n'


def joint(name, kind, parent, child, xyz="0 0 0", rpy="0 0 0", axis="0 1 0", more=""):
    return (f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}" rpy="{rpy}"/><parent link="{parent}"/>'
            f'<child link="{child}"/><axis xyz="{axis}"/>{more}</joint>\n')


LIMIT = '<limit lower="-1" upper="2" effort="5" velocity="3"/>'
MOMENTS = (1e-4, 3e-4, 2e-4)
BAR = (inertial(0.1, MOMENTS, "0.1 0 0"), box("0.2 0.02 0.01", "0.1 0 0"))


def urdf(tmp_path, *parts, name="robot.urdf"):
    path = tmp_path / name
    path.write_text('<?xml version="1.0"?>\n<robot name="robot">\n' + "".join(parts) + "</robot>\n")
    return str(path)


def pendulum(tmp_path, first=LIMIT, second="", **more):
    return urdf(tmp_path, link("base"), joint("top", "revolute", "base", "upper", "0 0 0.5", "0.2 0 0", "0 1 0", first),
                link("upper", *BAR), link("lower", *BAR),
                joint("middle", "continuous", "upper", "lower", "0.2 0 0", "0 0 0.3", "0 0 1", second))


def make(file, robot=None, step="1 ms", integrator="bdf2", gravity=GRAVITY, bodies=None, **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": gravity,
                       "bodies": {"robot": {"type": "urdf", "file": file, **(robot or {})}, **(bodies or {})}, **more})


def by_hand(turn, position, **more):
    """The pendulum as a scene; `turn` and `position` are the pose of the base."""
    upper = turn * Rotation.from_rotvec([0.2, 0, 0])
    lower = upper * Rotation.from_rotvec([0, 0, 0.3])
    at = position + turn.apply([0, 0, 0.5])
    knee = at + upper.apply([0.2, 0, 0])

    def metres(v):
        return " ".join(repr(float(x)) for x in v) + " m"

    def bar(origin, frame):
        return {"type": "rigid", "shape": {"box": "200 20 10 mm"}, "mass": "100 g",
                "inertia": "1e-4 3e-4 2e-4 kg m^2", "pose": {
                    "position": metres(origin + frame.apply([0.1, 0, 0])),
                    "rotation": " ".join(repr(float(x)) for x in frame.as_rotvec()) + " rad"}}

    def axis(v):
        return " ".join(repr(float(x)) for x in v)

    return sinew.load({
        "sinew": 1, "time_step": "1 ms", "integrator": "bdf2", "gravity": GRAVITY,
        "bodies": {"upper": bar(at, upper), "lower": bar(knee, lower)},
        "joints": {"top": {"type": "hinge", "bodies": ["world", "upper"], "point": metres(at),
                           "axis": axis(upper.apply([0, 1, 0])), "limits": {"angle": {"min": "-1 rad", "max": "2 rad"}}},
                   "middle": {"type": "hinge", "bodies": ["upper", "lower"], "point": metres(knee),
                              "axis": axis(lower.apply([0, 0, 1]))}}, **more})


def test_a_double_pendulum_swings_as_the_one_written_by_hand(tmp_path):
    turn, position = Rotation.from_rotvec([0.1, -0.4, 0.7]), np.array([0.3, -0.2, 0.1])
    ours = make(pendulum(tmp_path), {"pose": {"position": "0.3 -0.2 0.1 m", "rotation": "0.1 -0.4 0.7 rad"}})
    theirs = by_hand(turn, position)
    assert list(ours.bodies) == ["robot.upper", "robot.lower"]
    for _ in range(4):
        ours.run(duration=0.1)
        theirs.run(duration=0.1)
        for name in ("upper", "lower"):
            one, other = ours.body("robot." + name), theirs.body(name)
            np.testing.assert_allclose(one.centre_of_mass, other.centre_of_mass, atol=1e-9)
            np.testing.assert_allclose(one.velocity, other.velocity, atol=1e-8)
            np.testing.assert_allclose(one.rotation, other.rotation, atol=1e-9)
            # The frame of a link is at its joint.
            frame = Rotation.from_quat(np.roll(one.rotation, -1))
            np.testing.assert_allclose(one.position, other.position - frame.apply([0.1, 0, 0]), atol=1e-9)
        for name in ("top", "middle"):
            assert ours.joint("robot." + name).angle == pytest.approx(theirs.joint(name).angle, abs=1e-9)
    assert abs(ours.joint("robot.middle").angle) > 0.1


def test_angles_at_the_start(tmp_path):
    sim = make(pendulum(tmp_path), {"angles": {"top": "30 deg", "middle": "1 rad"}}, gravity="0 0 0 m/s^2")
    upper = Rotation.from_rotvec([0.2, 0, 0]) * Rotation.from_rotvec([0, np.pi / 6, 0])
    lower = upper * Rotation.from_rotvec([0, 0, 1.3])
    frame = Rotation.from_quat(np.roll(sim.body("robot.lower").rotation, -1))
    np.testing.assert_allclose(frame.as_matrix(), lower.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(sim.body("robot.lower").position, [0, 0, 0.5] + upper.apply([0.2, 0, 0]), atol=1e-12)
    # The limits refer to the zero of the file: the stop at 2 rad is 2 - pi / 6 from the initial angle.
    pushed = make(pendulum(tmp_path), {"angles": {"top": "30 deg"}}, gravity="0 0 0 m/s^2",
                  integrator="backward-euler", actuators={
                      "motor": {"type": "motor", "joint": "robot.top", "command": {"torque": "0.1 N m"}}})
    pushed.run(duration=1.0)
    assert pushed.joint("robot.top").angle == pytest.approx(2 - np.pi / 6, abs=1e-7)


def test_motors_drive_an_arm_within_the_limits_of_the_file(tmp_path):
    motors = {"shoulder": {"type": "motor", "joint": "robot.top", "command": {"angle": "-0.5 rad"}},
              "elbow": {"type": "motor", "joint": "robot.middle", "command": {"angle": "0.4 rad"}}}
    sim = make(pendulum(tmp_path), integrator="backward-euler", step="20 ms", actuators=motors)
    sim.step(2)
    assert sim.joint("robot.top").angle == pytest.approx(-2 * 0.02 * 3, abs=1e-9)  # 3 rad/s
    sim.run(duration=2.0)
    assert sim.joint("robot.top").angle == pytest.approx(-0.5, abs=1e-9)
    assert sim.joint("robot.middle").angle == pytest.approx(0.4, abs=1e-9)
    # The torques balance the weights about the axes.
    weight, centres = 0.1 * 9.81, [sim.body(b).centre_of_mass for b in ("robot.upper", "robot.lower")]
    moment = sum(np.cross(c - [0, 0, 0.5], [0, 0, weight]) for c in centres)
    assert sim.actuator("shoulder").torque == pytest.approx(
        Rotation.from_rotvec([0.2, 0, 0]).apply([0, 1, 0]) @ moment, rel=1e-8)  # to the tolerance of a step
    weak = make(pendulum(tmp_path, '<limit lower="-1" upper="2" effort="0.2" velocity="30"/>'), integrator="bdf2",
                actuators=motors)
    weak.run(duration=0.3)
    assert abs(weak.actuator("shoulder").torque) <= 0.2 + 1e-9
    assert weak.joint("robot.top").angle > -0.4  # too weak to lift it


def test_a_prismatic_joint_slides_with_friction_and_limits(tmp_path):
    file = urdf(tmp_path, link("base"), link("cart", inertial(0.5, (1e-3, 1e-3, 1e-3)), box("0.1 0.1 0.1")),
                joint("rail", "prismatic", "base", "cart", "0 0 0.2", "0 0 0", "1 0 0",
                      '<limit lower="-0.1" upper="0.3" effort="100" velocity="10"/><dynamics friction="0.7"/>'))
    sim = make(file, {"displacements": {"rail": "50 mm"}}, integrator="backward-euler",
               actuators={"push": {"type": "linear-motor", "joint": "robot.rail", "command": {"force": "0.6 N"}}})
    np.testing.assert_allclose(sim.body("robot.cart").position, [0.05, 0, 0.2], atol=1e-15)
    sim.run(duration=0.2)
    assert abs(sim.joint("robot.rail").displacement) < 1e-9  # friction holds it
    sim.actuator("push").force = 5.0
    sim.run(duration=0.5)
    assert sim.joint("robot.rail").displacement == pytest.approx(0.25, abs=1e-7)


def test_fixed_links_weld_or_are_part_of_their_parent(tmp_path):
    tool = link("tool", box("0.01 0.01 0.01", kind="visual"))
    parts = [link("world"), link("base", inertial(1, (1, 1, 1)), box("0.1 0.1 0.1")), link("arm", *BAR), tool,
             link("tcp"), link("hand", inertial(0.05, MOMENTS), box("0.04 0.04 0.04")),
             joint("mount", "fixed", "world", "base", "0 0 1"), joint("shoulder", "continuous", "base", "arm"),
             joint("flange", "fixed", "arm", "tool", "0.2 0 0"), joint("end", "fixed", "tool", "tcp", "0.05 0 0"),
             joint("grip", "fixed", "tcp", "hand", "0.02 0 0", "0 0 0.5")]
    sim = make(urdf(tmp_path, *parts), effectors={"tip": {"body": "robot.tcp", "point": "0.25 0 1 m", "outside": "nearest"}})
    assert list(sim.bodies) == ["robot.base", "robot.arm", "robot.hand"]
    run = sim.run(duration=0.2, record=["robot.tool.position", "robot.arm.position"])
    np.testing.assert_array_equal(run["robot.tool.position"], run["robot.arm.position"])
    for name in ("robot.tool", "robot.tcp"):  # links without inertia are names of the body that they are part of
        np.testing.assert_array_equal(sim.body(name).position, sim.body("robot.arm").position)
    with pytest.raises(sinew.Error, match="part of the world") as error:
        sim.body("robot.world")
    assert error.value.kind == "unknown-name"
    np.testing.assert_array_equal(sim.body("robot.base").position, [0, 0, 1])
    arm, hand = sim.body("robot.arm"), sim.body("robot.hand")
    turn = Rotation.from_quat(np.roll(arm.rotation, -1))
    np.testing.assert_allclose(hand.position, arm.position + turn.apply([0.27, 0, 0]), atol=1e-9)
    np.testing.assert_allclose(sim.effector("tip").position, arm.position + turn.apply([0.25, 0, 0]), atol=1e-12)
    assert np.linalg.norm(sim.joint("robot.grip").force) > 0.01
    assert sim.joint("robot.grip").type == "weld"


def test_a_free_root_falls_and_a_floating_joint_is_none(tmp_path):
    file = urdf(tmp_path, link("foot"), link("body", inertial(0.5, MOMENTS), box("0.1 0.1 0.1")), link("ball", *BAR),
                joint("a", "fixed", "foot", "body", "0 0 0.1"), joint("b", "floating", "body", "ball", "1 0 0"))
    sim = make(file, {"fixed": False}, gravity="0 0 -10 m/s^2", integrator="backward-euler", step="0.1 ms")
    assert list(sim.bodies) == ["robot.body", "robot.ball"] and not sim.joints
    sim.run(duration=0.1)
    for name, x, z in (("robot.body", 0, 0.1), ("robot.ball", 1, 0.1)):
        np.testing.assert_allclose(sim.body(name).position, [x, 0, z - 0.05], atol=1e-4)


def test_inertia_is_turned_and_comes_from_the_geometry_with_a_density(tmp_path):
    file = urdf(tmp_path, link("base"), link("a", inertial(0.2, MOMENTS, "0.01 0.02 0.03", "0.3 -0.5 0.7")),
                joint("ja", "continuous", "base", "a"),
                link("b", box("0.1 0.2 0.3", "1 0 0", "0 0 0.4"), box("0.1 0.2 0.3", "-1 0 0", "0 0 0.4")),
                joint("jb", "continuous", "base", "b"))
    with pytest.raises(sinew.Error, match=r"robot.urdf:\d+: link 'b': it moves and has no mass.*density: 1000") as error:
        make(file)
    assert error.value.kind == "missing-mass"
    sim = make(file, {"density": "1000 kg/m^3"})
    turn = Rotation.from_euler("xyz", [0.3, -0.5, 0.7]).as_matrix()
    np.testing.assert_allclose(sim.body("robot.a").inertia, turn @ np.diag(MOMENTS) @ turn.T, atol=1e-16)
    np.testing.assert_allclose(sim.body("robot.a").centre_of_mass, [0.01, 0.02, 0.03], atol=1e-15)
    turn = Rotation.from_rotvec([0, 0, 0.4]).as_matrix()
    one = turn @ np.diag(6 / 12 * np.array([0.04 + 0.09, 0.01 + 0.09, 0.01 + 0.04])) @ turn.T
    np.testing.assert_allclose(sim.body("robot.b").inertia, 2 * one + 12 * np.diag([0, 1, 1]), atol=1e-12)
    assert sim.body("robot.b").mass == pytest.approx(12, rel=1e-12)


def test_meshes_are_found_in_folders_and_packages(tmp_path):
    (tmp_path / "parts" / "meshes").mkdir(parents=True)
    nodes, triangles = solids.box(np.array([100, 20, 20]), (50, 0, 0))
    solids.write_stl(tmp_path / "parts" / "meshes" / "bar.stl", nodes, triangles)

    def robot(path, scale="0.001 0.001 0.001"):
        return urdf(tmp_path, link("base"), joint("j", "continuous", "base", "bar"), link(
            "bar", f'<collision><geometry><mesh filename="{path}" scale="{scale}"/></geometry></collision>'))

    packages = {"packages": {"arm": str(tmp_path / "parts")}, "density": "1000 kg/m^3"}
    for path in ("package://arm/meshes/bar.stl", "parts/meshes/bar.stl", f"file://{tmp_path}/parts/meshes/bar.stl"):
        sim = make(robot(path), packages)
        assert sim.body("robot.bar").mass == pytest.approx(0.04, rel=1e-9)
        np.testing.assert_allclose(sim.body("robot.bar").centre_of_mass, [0.05, 0, 0], atol=1e-9)
    mirrored = make(robot("parts/meshes/bar.stl", "-0.001 0.001 0.001"), packages)
    np.testing.assert_allclose(mirrored.body("robot.bar").centre_of_mass, [-0.05, 0, 0], atol=1e-9)
    for path, message, kind in (("package://leg/bar.stl", r"package 'leg' is not known.*packages: \{leg: FOLDER\}", "unknown-name"),
                                ("package://arm/none.stl", "there is no file package://arm/none.stl; looked for", "file-not-found"),
                                ("robot.urdf", "none of the mesh formats", "unknown-format")):
        with pytest.raises(sinew.Error, match=message) as error:
            make(robot(path), packages)
        assert error.value.kind == kind and "robot.urdf:" in str(error.value)
    with pytest.raises(sinew.Error, match="there is no folder"):
        make(robot("package://arm/bar.stl"), {"packages": {"arm": str(tmp_path / "none")}})


def test_a_visual_of_another_format_is_drawn_as_the_collision(tmp_path):
    (tmp_path / "look.dae").write_text("<COLLADA/>")
    visual = '<visual><geometry><mesh filename="look.dae"/></geometry></visual>'
    with pytest.warns(sinew.SinewWarning, match=r"robot.urdf:\d+.*collision geometry is drawn.*unused-element"):
        sim = make(urdf(tmp_path, link("base"), link("arm", *BAR, visual), joint("j", "continuous", "base", "arm")))
    assert np.ptp(sim.body("robot.arm").positions[:, 0]) == pytest.approx(0.2)


def test_one_mesh_touches_with_its_hull(tmp_path):
    nodes, triangles = solids.box(np.array([0.2, 0.02, 0.01]), (0.1, 0, 0))
    solids.write_stl(tmp_path / "bar.stl", nodes, triangles)
    mesh = '<collision><geometry><mesh filename="bar.stl"/></geometry></collision>'
    sim = make(urdf(tmp_path, link("base"), link("arm", BAR[0], mesh), joint("j", "continuous", "base", "arm", "0 0 0.1")),
               integrator="backward-euler", contacts={"floor": {"body": "robot.arm", "surface": {"plane": {}}}})
    sim.run(duration=0.5)
    angle = sim.joint("robot.j").angle
    assert 0.2 * np.sin(angle) + 0.005 * np.cos(angle) == pytest.approx(0.1, abs=1e-5)


def test_runs_keep_the_paths_of_a_robot(tmp_path, monkeypatch):
    (tmp_path / "parts").mkdir()
    solids.write_stl(tmp_path / "parts" / "bar.stl", *solids.box(np.array([0.2, 0.02, 0.01]), (0.1, 0, 0)))
    mesh = '<visual><geometry><mesh filename="package://arm/bar.stl"/></geometry></visual>'
    urdf(tmp_path, link("base"), link("arm", BAR[0], mesh), joint("j", "continuous", "base", "arm"))
    scene = tmp_path / "scene.yaml"
    scene.write_text("sinew: 1\ntime_step: 1 ms\nintegrator: bdf2\nbodies:\n"
                     "  r: {type: urdf, file: robot.urdf, packages: {arm: parts}}\n")
    sim = sinew.load(scene, set={"bodies.r.angles": "{j: 90 deg}"})
    np.testing.assert_allclose(sim.body("r.arm").positions[:, 2].min(), -0.2, atol=1e-9)
    monkeypatch.chdir("/")
    np.testing.assert_allclose(sinew.load(scene).body("r.arm").positions[:, 2].min(), -0.005, atol=1e-9)


def test_contact_of_links(tmp_path):
    file = urdf(tmp_path, link("base", box("1 1 0.1", "0 0 -0.05")), link("arm", *BAR),
                joint("j", "continuous", "base", "arm", "0 0 0.1"))
    sim = make(file, integrator="backward-euler", contacts={"floor": {"between": ["robot.base", "robot.arm"]}})
    sim.run(duration=0.5)
    # The end of the bar, 0.2 m from the axis and 5 mm below the midline, lies on the floor, 0.1 m lower.
    angle = sim.joint("robot.j").angle
    assert 0.2 * np.sin(angle) + 0.005 * np.cos(angle) == pytest.approx(0.1, abs=1e-5)


def test_what_is_not_used_is_named_with_its_line(tmp_path):
    file = urdf(tmp_path, '<transmission name="t"/>\n', '<gazebo reference="base"/>\n', '<gazebo/>\n', link("base"),
                link("arm", *BAR), joint("j", "continuous", "base", "arm",
                                         more='<dynamics damping="0.1"/><safety_controller k_velocity="1"/>'))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        make(file)
    told = [str(w.message) for w in caught]
    for line, what in ((3, "<transmission>"), (4, "<gazebo>"), (12, "<safety_controller> of a joint"),
                       (12, "viscous damping of a joint")):
        assert any(f"robot.urdf:{line}" in text and what in text for text in told), (line, what, told)
    assert len(told) == 4


BASE = link("base")
ARM = link("arm", *BAR)
HINGE = joint("j", "continuous", "base", "arm")


@pytest.mark.parametrize("parts,message,kind", [
    ([BASE, "<link name="], r"robot.urdf:6: this is no XML", "syntax-error"),
    ([BASE, ARM], "'base' and 'arm' have no parent both", "malformed-file"),
    ([], "has no <link>", "malformed-file"),
    ([BASE, ARM, joint("j", "continuous", "base", "amr")], r"robot.urdf:9.*'j'.*'amr' is not a link; did you mean 'arm'", "unknown-name"),
    ([BASE, ARM, HINGE, HINGE], r"robot.urdf:10.*line 9 has a <joint> of this name", "duplicate-key"),
    ([BASE, BASE], "line 3 has a <link> of this name", "duplicate-key"),
    ([BASE, ARM, HINGE, joint("k", "continuous", "base", "arm")], "has a parent already, by the joint of line 9", "malformed-file"),
    ([BASE, ARM, HINGE, joint("k", "continuous", "arm", "base")], "hangs on itself|has no parent", "malformed-file"),
    ([BASE, ARM, link("c", *BAR), HINGE.replace('"base"', '"c"'), joint("k", "continuous", "arm", "c")], "link 'arm' hangs on itself|link 'c' hangs on itself", "malformed-file"),
    ([BASE, ARM, joint("j", "planar", "base", "arm")], "a planar joint is not in this version|planar joint", "not-in-this-version"),
    ([BASE, ARM, joint("j", "screw", "base", "arm")], "no joint of type 'screw'", "unknown-choice"),
    ([BASE, ARM, joint("j", "revolute", "base", "arm")], "(?i)limits", "malformed-file"),
    ([BASE, ARM, joint("j", "revolute", "base", "arm", more='<limit lower="1" upper="-1" effort="1" velocity="1"/>')], "lower limit is 1", "contradictory-limits"),
    ([BASE, ARM, joint("j", "revolute", "base", "arm", more='<limit lower="-3" upper="-1" effort="1" velocity="1"/>')], r"starts at 0, outside its limits -3 and -1; write angles: \{j: -2 rad\}", "contradictory-limits"),
    ([BASE, ARM, joint("j", "continuous", "base", "arm", more='<mimic joint="k"/>')], "<mimic>", "not-in-this-version"),
    ([BASE, ARM, joint("j", "continuous", "base", "arm", axis="0 0 0")], "<axis> has no length", "out-of-range"),
    ([BASE, link("arm", inertial(-1, MOMENTS)), HINGE], "its mass is -1 kg", "out-of-range"),
    ([BASE, link("arm", inertial(1, (1, 1, 3))), HINGE], "belong to no body", "out-of-range"),
    ([BASE, link("arm", inertial("heavy", MOMENTS)), HINGE], "robot.urdf:6.*heavy|robot.urdf.*mass", "malformed-file"),
    ([BASE, link("arm", inertial(1, MOMENTS), box("1 0 1")), HINGE], "an edge is not positive", "out-of-range"),
    ([BASE, link("arm"), HINGE], "it moves and has no mass; add <inertial>", "missing-mass"),
    ([link("the base"), ARM, HINGE], "is not a name", "bad-argument"),
    ([BASE, link("arm", inertial("%s%n", MOMENTS)), HINGE], "robot.urdf:7.*holds a '%'", "bad-argument"),
    ([BASE, ARM, HINGE, "<xacro:macro/>"], "xacro", "malformed-file"),
])
def test_files_that_are_wrong_are_named(tmp_path, parts, message, kind):
    with pytest.raises(sinew.Error, match=message) as error:
        make(urdf(tmp_path, *parts))
    assert error.value.kind == kind
    assert "robot.urdf" in str(error.value)


def test_scenes_that_name_what_is_not_there(tmp_path):
    file = pendulum(tmp_path)
    force = {"type": "force", "force": "0 0 1 N", "point": "0 0 0 m"}
    motor = {"type": "motor", "command": {"torque": "1 N m"}}
    for more, message, kind in (
            ({"loads": {"f": {**force, "body": "robot.uper"}}}, "no link 'robot.uper'.*did you mean 'robot.upper'", "unknown-name"),
            ({"loads": {"f": {**force, "body": "robo.upper"}}}, "'robo.upper'|robo.upper", "unknown-name"),
            ({"loads": {"f": {**force, "body": "robot"}}}, "robot of several bodies", "wrong-type"),
            ({"actuators": {"m": {**motor, "joint": "robot.midle"}}}, "no joint 'robot.midle'.*'robot.middle'", "unknown-name"),
            ({"robot": {"angles": {"tap": "1 rad"}}}, "'tap' is not a joint that turns", "unknown-name"),
            ({"robot": {"displacements": {"top": "1 mm"}}}, "'top' is not a joint that slides", "unknown-name"),
            ({"robot": {"file": "none.urdf"}}, "there is no file", "file-not-found")):
        with pytest.raises(sinew.Error, match=message) as error:
            make(file, **more)
        assert error.value.kind == kind, more


def test_states_of_robots(tmp_path):
    one, other = make(pendulum(tmp_path)), make(pendulum(tmp_path))
    one.run(duration=0.05)
    one.save_state(tmp_path / "state")
    other.load_state(tmp_path / "state")
    twin = one.clone()
    for sim in (one, other, twin):
        sim.run(duration=0.05)
        assert np.array_equal(sim.body("robot.lower").positions, one.body("robot.lower").positions)
