"""Inverse control from Python."""

import gc
import pathlib

import numpy as np
import pytest
import sinew
import yaml

TARGET = [0.004, 0.003, 0.0788]


def test_reaches_its_target(sim):
    ik = sinew.InverseController(sim, targets={"tip": TARGET})
    ik.step(40)
    assert ik.status == "on-target"
    assert ik.error < 1e-6
    assert sim.effector("tip").position == pytest.approx(TARGET, abs=1e-6)
    assert ik.errors == {"tip": ik.error}
    assert ik.actuators == ["east", "north", "west", "south", "push"]
    assert ik.efforts == pytest.approx(
        [sim.actuator(n).tension for n in ik.actuators[:4]] + [sim.actuator("push").force]
    )


def test_targets_from_python_each_step(sim):
    ik = sinew.InverseController(sim, targets={"tip": [0, 0, 0.079]})
    ik.step(10)
    for angle in np.linspace(0, 1, 50):
        ik.targets["tip"] = [0.003 * np.sin(angle), 0, 0.079]
        ik.step()
    assert ik.error < 1e-4
    assert ik.targets["tip"] == pytest.approx([0.003 * np.sin(1), 0, 0.079])
    ik.targets = {"tip": TARGET}
    assert list(ik.targets) == ["tip"] and "tip" in ik.targets and len(ik.targets) == 1
    ik.step(40)
    assert ik.error < 1e-6


def test_moving_targets(sim):
    circle = sinew.Circle([0, 0, 0.078], 0.004, period=1.0)
    assert circle.at(0.25) == pytest.approx([0, 0.004, 0.078])
    ik = sinew.InverseController(sim, targets={"tip": circle})
    result = sim.run(2.0)
    assert result["error"][-100:].max() < 2e-4
    assert ik.targets["tip"].end_time == 1.0
    line = sinew.Polyline([[0, 0, 0.078], [0.004, 0, 0.078]], period=0.5)
    assert line.at(0.25) == pytest.approx([0.002, 0, 0.078])
    path = sinew.Trajectory([0, 1], [[0, 0, 0.078], [0, 0.004, 0.078]])
    assert path.at(0.5) == pytest.approx([0, 0.002, 0.078])
    for target in (line, path):
        ik.targets["tip"] = target
        ik.step(50)
        assert ik.error < 1e-4


def test_owns_its_actuators_until_detached(sim):
    with sinew.InverseController(sim, targets={"tip": TARGET}) as ik:
        ik.step(20)
        assert sim.actuator("east").owned
        for change in ("tension", "displacement"):
            with pytest.raises(sinew.Error) as caught:
                setattr(sim.actuator("east"), change, 0.0)
            assert caught.value.kind == "actuator-owned"
        assert sim.controller.attached
    assert not ik.attached and sim.controller is None
    # The actuators hold their present displacements.
    before = sim.effector("tip").position
    sim.step(30)
    assert sim.effector("tip").position == pytest.approx(before, abs=1e-4)
    sim.actuator("east").tension = 0.0
    with pytest.raises(sinew.Error) as caught:
        ik.step()
    assert caught.value.kind == "bad-argument"
    ik.detach()


def test_uses_only_the_actuators_it_is_given(sim):
    sim.actuator("push").force = 0.1
    ik = sinew.InverseController(
        sim, targets={"tip": [0, 0.004, 0.079]}, actuators=["north", "south"],
        weights={"tip": [0.0, 1.0, 0.0]},
    )
    ik.step(40)
    assert ik.actuators == ["north", "south"]
    assert sim.effector("tip").position[1] == pytest.approx(0.004, abs=1e-5)
    assert sim.actuator("push").force == pytest.approx(0.1)
    sim.actuator("push").force = 0.2
    ik.step(5)
    assert sim.actuator("push").force == pytest.approx(0.2)


def test_says_when_the_target_is_out_of_reach(sim):
    ik = sinew.InverseController(sim, targets={"tip": [0, 0, 0.2]})
    ik.step(300)
    held = sim.effector("tip").position
    ik.step(20)
    assert ik.status == "out-of-reach"
    assert sim.effector("tip").position == pytest.approx(held, abs=1e-5)
    assert (ik.efforts[:4] >= 0).all()


def test_the_scenes_controller_is_attached_on_load(follow):
    sim = sinew.load(follow)
    assert sim.controller.name == "follow"
    with pytest.raises(sinew.Error) as caught:
        sim.actuator("east").tension = 1.0
    assert caught.value.kind == "actuator-owned"
    with pytest.raises(sinew.Error) as caught:
        sinew.InverseController(sim, targets={"tip": TARGET})
    assert caught.value.kind == "actuator-owned" and "sim.detach()" in caught.value.remedy
    result = sim.run()
    assert result["time"][-1] == pytest.approx(2.0)
    assert result["error"][-1] < 1e-4
    sim.detach()
    sim.detach()
    assert sim.controller is None
    sinew.InverseController(sim, targets={"tip": TARGET}).step()


def test_stays_attached_when_the_object_is_dropped(sim):
    ik = sinew.InverseController(sim, targets={"tip": TARGET})
    ik.step()
    del ik
    gc.collect()
    sim.step(40)
    assert sim.controller.status == "on-target"
    sim.controller.targets["tip"] = [0, 0.003, 0.079]
    sim.step(40)
    assert sim.controller.error < 1e-5


def test_keeps_its_simulation_alive(scene):
    ik = sinew.InverseController(sinew.load(scene), targets={"tip": TARGET})
    gc.collect()
    ik.step(40)
    assert ik.status == "on-target"


def test_reset_keeps_the_controller(sim):
    ik = sinew.InverseController(sim, targets={"tip": TARGET})
    ik.step(30)
    first = sim.state_hash
    sim.reset()
    assert ik.attached
    ik.step(30)
    assert sim.state_hash == first


def finger(limits, solver=None):
    cables = {"east": (17, 10), "north": (10, 17), "west": (3, 10), "south": (10, 3)}
    scene = {
        "sinew": 1, "time_step": 0.01,
        "bodies": {"finger": {
            "type": "fem", "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.1, "element_size": 0.01},
            "material": {"young_modulus": 3e5, "poisson_ratio": 0.4}, "fixed": {"set": "z_min"}}},
        "actuators": {name: {
            "type": "cable", "body": "finger", "limits": limits,
            "points": [[1e-3 * x, 1e-3 * y, z] for z in np.linspace(0, 0.1, 6)]} for name, (x, y) in cables.items()},
        "effectors": {"tip": {"body": "finger", "point": [0.01, 0.01, 0.1]}}}
    return sinew.load(scene if solver is None else {**scene, "solver": solver})


FAR = [0.03, 0.01, 0.09]
SIZE = np.linalg.norm([0.02, 0.02, 0.1])


@pytest.mark.parametrize("limits", [{"max": 0.006}, {"max": 0.02, "rate": 0.01}], ids=["range", "rate"])
def test_limits_of_displacement_hold_while_targets_jump(limits):
    sim = finger({"tension": {"min": 0, "max": 8}, "displacement": limits})
    ik = sinew.InverseController(sim, targets={"tip": FAR})
    pulled = []
    for step in range(300):
        if step == 150:
            ik.targets["tip"] = [-0.01, 0.02, 0.09]
        ik.step()
        assert sim.report.status == "solved"
        pulled.append([cable.displacement for cable in sim.actuators.values()])
    assert np.max(pulled) <= limits["max"] + 1e-6 * SIZE
    # In each case, one limit is reached: of the range or of the rate.
    if "rate" in limits:
        fastest, allowed = np.abs(np.diff(pulled, axis=0)).max(), limits["rate"] * 0.01
        assert 0.99 * allowed < fastest <= allowed + 2e-6 * SIZE
    else:
        assert np.max(pulled) > 0.99 * limits["max"]


# At the default part of 0.02, one linearisation from rest would leave more than a tenth of the forces out of balance.
@pytest.mark.parametrize("solver, given", [(None, {}), ("one-linearisation", {"largest_step": 0.002})], ids=["None", "one-linearisation"])
def test_a_step_closes_its_part_of_the_gap_and_no_more(solver, given):
    sim = finger({"tension": {"min": 0}}, solver)
    start = sim.effector("tip").position
    ik = sinew.InverseController(sim, targets={"tip": FAR}, **given)
    ik.step()
    moved = np.linalg.norm(sim.effector("tip").position - start)
    assert moved == pytest.approx(given.get("largest_step", 0.02) * SIZE, rel=0.05)


def test_steps_of_one_linearisation_go_as_far_as_forces_balance():
    sim = finger({"tension": {"min": 0}}, "one-linearisation")
    start = sim.effector("tip").position
    ik = sinew.InverseController(sim, targets={"tip": FAR})
    for step in range(300):
        ik.step()
        assert sim.report.status == "solved" and sim.report.relative_residual <= 0.1
        if step == 0:
            assert 0.0 < np.linalg.norm(sim.effector("tip").position - start) < 0.02 * SIZE
    assert ik.status == "on-target"


PULLED_STRAIGHT = """
sinew: 1
time_step: 5 ms
integrator: backward-euler
solver: {method: newton, tangent: exact, factorisation: block, ordering: fastest}
gravity: -3 0 -5 m/s^2
bodies:
  arm:
    type: pcc
    segments:
    - {length: 30 mm, mass: 10 g, stiffness: 0.02 N m, damping: 2e-4 N m s, bending: spatial}
    - {length: 30 mm, mass: 10 g, stiffness: 0.02 N m, damping: 2e-4 N m s}
  link:
    type: rigid
    shape: {cylinder: {radius: 8 mm, height: 60 mm}}
    density: 1000 kg/m^3
    pose: {position: 30 8 -48 mm, rotation: {axis: y, angle: 90 deg}}
joints:
  seam: {type: hinge, bodies: [arm, link], point: 0 8 -48 mm, axis: 0 1 0}
actuators:
  motor: {type: motor, joint: seam, limits: {torque: {min: -0.1 N m, max: 0.1 N m}}}
  cable:
    type: cable
    body: link
    outside: nearest
    pull: world
    points: [3 14 -49 mm, 30 14 -48.9 mm, 57 12.8 -49 mm]
    limits: {tension: {max: 5 N}, displacement: {min: -10 mm, max: 8 mm}}
    friction: 0.3
  push:
    type: force
    body: link
    point: 54 8 -48 mm
    direction: 1 1 0
    outside: nearest
    limits: {force: {min: -2 N, max: 2 N}}
  twist: {type: torque, body: arm, segment: 1, limits: {torque: {min: -0.1 N m, max: 0.1 N m}}}
effectors:
  tip: {body: arm, outside: nearest, point: 0 0 -60 mm}
controllers:
  follow:
    type: inverse
    effectors: {tip: {target: 0.228299 -0.140395 -60.5759 mm}}
    actuators: [motor, cable, push, twist]
    regularisation: {of: effort}
"""


def test_a_choice_that_goes_back_and_forth_comes_to_rest(tmp_path):
    """The target is beyond the length of the arm, which has more actuators than the target has directions."""
    path = tmp_path / "scene.yaml"
    path.write_text(PULLED_STRAIGHT)
    sim = sinew.load(path)
    errors = [sim.controller.error]
    held = 0
    for _ in range(8):
        sim.step()
        # Reported if the choice does not settle within eight iterations, the limit of a controller.
        assert sim.report.choice_held == (sim.report.iterations > 8)
        held += sim.report.choice_held
        errors.append(sim.controller.error)
    assert held > 0
    assert not sim.report.flagged
    assert max(errors) < 1.1 * errors[0]


@pytest.mark.parametrize("size", [0.01, 0.1, 10.0])
def test_a_rotation_goes_as_far_in_a_step_whatever_the_robots_size(size):
    lever = {"type": "rigid", "shape": {"box": [size, 0.1 * size, 0.1 * size]}, "density": "1000 kg/m^3"}
    frame = [[0.0, 0.0, 0.0], [0.1 * size, 0.0, 0.0], [0.0, 0.01 * size, 0.0]]
    sim = sinew.load({
        "sinew": 1, "gravity": "0 0 0 m/s^2", "integrator": "backward-euler", "time_step": "10 ms",
        "bodies": {"lever": lever},
        "joints": {"pin": {"type": "hinge", "bodies": ["world", "lever"], "point": [0.0, 0.0, 0.0], "axis": "z"}},
        "actuators": {"motor": {"type": "motor", "joint": "pin"}},
        "effectors": {"turn": {"body": "lever", "orientation": frame}},
    })  # fmt: skip
    sinew.InverseController(sim, targets={"turn": [0.0, 0.0, 1.0]}, largest_step=0.03).step()
    # The regularisation reduces the motion by about 1e-3.
    assert sim.effector("turn").value[2] == pytest.approx(0.03, rel=2e-3)


def test_a_step_that_fails_is_rejected():
    """A trunk pressed against a wall is about to buckle: a step towards the target would turn elements inside out."""
    folder = pathlib.Path(__file__).parents[2] / "examples" / "trunk"
    tree = yaml.safe_load((folder / "trunk.yaml").read_text())
    for actuator in tree["actuators"].values():
        actuator["limits"] = {"tension": {"min": "0 N", "max": "20 N"}, "displacement": {"rate": "100 mm/s"}}
        actuator["command"] = {"tension": 0.0}
    tree["contacts"] = {"wall": {"body": "trunk", "surface": {"plane": {"point": "25 0 0 mm", "normal": "-1 0 0"}}}}
    sim = sinew.load(tree, folder=str(folder))
    ik = sinew.InverseController(sim, targets={"tip": (0.01936764, 0.07741671, 0.08498362)})
    ik.step(90)
    before = np.array(sim.effector("tip").position)
    ik.step(30)
    assert np.linalg.norm(sim.effector("tip").position - before) < 1e-6  # m
    assert ik.status in ("held-back", "out-of-reach", "local-optimum") and 1e-3 < ik.error < 3e-3
    ik.targets["tip"] = (0.0, 0.03, 0.18)
    ik.step(80)
    assert ik.status == "on-target"


@pytest.mark.parametrize("solver", ["newton", "one-linearisation"])
@pytest.mark.parametrize("asked", [0.045, 0.1])
def test_one_cable_settles_at_the_fold_of_what_it_reaches(scene, solver, asked):
    """The x coordinate of the tip has a maximum within the range of the cable: with more pull, the tip moves back."""
    tree = yaml.safe_load(scene.read_text())
    limits = {"tension": {"max": "80 N"}, "displacement": {"min": 0.0, "max": "60 mm", "rate": "100 mm/s"}}
    tree["actuators"] = {"east": {**tree["actuators"]["east"], "limits": limits}}
    tree["effectors"]["tip"]["directions"] = ["x"]
    del tree["duration"]
    scan = sinew.load(tree)
    pulled = scan.actuator("east")
    reached = []
    for pull in np.arange(0.5e-3, 36e-3, 0.5e-3):
        pulled.displacement = pull
        scan.step(2)
        reached.append(scan.effector("tip").position[0])
    best = np.argmax(reached)
    assert reached[-1] < 0.995 * reached[best]
    sim = sinew.load({**tree, "solver": solver})
    ik = sinew.InverseController(sim, targets={"tip": [asked, 0.0, 0.0]})
    ik.step(100)
    found, pulls = [], []
    for _ in range(200):
        ik.step()
        found.append(sim.effector("tip").position[0])
        pulls.append(sim.actuator("east").displacement)
    assert abs(found[-1] - reached[best]) < 1e-3 * reached[best]
    assert np.ptp(found) < 1e-7 and np.ptp(pulls) < 1e-5  # m
    assert ik.status == "local-optimum"
