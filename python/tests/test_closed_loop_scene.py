"""Controllers of type closed-loop: from Python, in runs, with saved states and clones."""

from pathlib import Path

import numpy as np
import pytest
import sinew

HOLD = Path(__file__).resolve().parents[2] / "examples" / "finger" / "hold.yaml"


@pytest.fixture
def held():
    return sinew.load(HOLD)


def test_the_example_holds_the_tip_while_something_pushes(held):
    controller = held.controller
    assert controller.name == "hold" and controller.sensors == {"tip": "tip"}
    assert controller.status == "not-started" and np.isnan(held.controller.measured_errors["tip"])
    held.step()
    assert controller.status == "holding" and "'tip' has delivered nothing yet" in controller.conflict
    record = held.run(3.0)
    assert controller.status == "on-target" and controller.conflict == ""
    error = np.linalg.norm((record["tip.target"] - record["tip.position"])[:, :2], axis=1)
    at = lambda time: round(time / held.time_step) - 2  # noqa: E731
    pushed = error[at(1.0) + 1:at(1.2)].max()
    assert pushed > 1e-3
    for time in (0.9, 1.9, 2.9):
        assert error[at(time) - 10:at(time)].mean() < 1.5e-4
    # The same push without the loop.
    free = sinew.load(HOLD)
    free.detach()
    free.solve_static()
    rest = free.effector("tip").position.copy()
    free.step(105)
    assert np.linalg.norm(free.effector("tip").position - rest) > 1e-3
    # On the way to the target, cables become slack, which is a limit.
    assert set(record["controller"]) == {"holding", "moving", "at-limits", "on-target"}
    assert np.isfinite(record["east.displacement_command"][10:]).all()
    assert controller.measured_errors["tip"] == pytest.approx(
        np.linalg.norm(held.sensor("tip").value - record["tip.target"][-1]), rel=0.2)


def test_clones_and_saved_states_go_on_bit_for_bit(held, tmp_path):
    held.step(30)
    held.save_state(tmp_path / "held.state")
    copy, other = held.clone(), sinew.load(HOLD, threads=2)
    other.load_state(tmp_path / "held.state")
    assert copy.controller.status == held.controller.status
    for sim in (held, copy, other):
        sim.step(80)
    assert held.state_hash == copy.state_hash == other.state_hash
    held.reset()
    assert held.controller.status == "not-started"
    held.step(30)
    again = sinew.load(HOLD)
    again.step(30)
    assert held.state_hash == again.state_hash


def test_commands_are_the_controllers(held):
    held.step(10)
    with pytest.raises(sinew.Error) as caught:
        held.actuator("east").displacement = 0.0
    assert caught.value.kind == "actuator-owned"
    told = held.actuator("east").command
    held.detach()
    held.step()
    assert held.actuator("east").command == told
    held.actuator("east").displacement = 0.0


def test_a_real_camera_may_stop(held):
    tip = held.sensor("tip")
    for _ in range(20):
        tip.feed(held.effector("tip").position, time=held.time)
        held.step()
    assert held.controller.status in ("moving", "at-limits", "on-target")
    held.step(14)
    assert held.controller.status == "holding" and "silent" in held.controller.conflict
    place = held.effector("tip").position.copy()
    held.step(5)
    np.testing.assert_allclose(held.effector("tip").position, place, atol=1e-9)


def test_dynamics_take_the_compliance_of_equilibrium():
    """A damped dynamic robot follows the target; the commands use the static compliance, without inertia."""
    sim = sinew.load(HOLD, set=["integrator=bdf2", "bodies.finger.damping={stiffness: 0.02 s}", "sensors.tip.noise=0 mm",
                                "controllers.hold.gain=3 1/s"])
    sim.step(95)
    assert sim.controller.status == "on-target"
    assert sim.controller.errors["tip"] < 1.5e-3


JOINT_THAT_RUBS = """
sinew: 1
time_step: 10 ms
bodies:
  arm:
    type: pcc
    segments:
    - {length: 30 mm, mass: 10 g, stiffness: 0.02 N m, bending: spatial}
    - {length: 30 mm, mass: 10 g, stiffness: 0.02 N m}
  link: {type: rigid, shape: {cylinder: {radius: 8 mm, height: 60 mm}}, density: 1000 kg/m^3,
         pose: {position: 30 8 -48 mm, rotation: {axis: y, angle: 90 deg}}}
joints:
  seam: {type: hinge, bodies: [arm, link], point: 0 8 -48 mm, axis: 0 1 0, friction: 0.1 mN m}
actuators:
  motor: {type: motor, joint: seam, command: {angle: 2.251 deg}}
  twist: {type: torque, body: arm, segment: 1, command: {torque: 3.818 N mm}, limits: {torque: {min: -0.1 N m, max: 0.1 N m}}}
effectors:
  tip: {body: arm, point: 0 0 -60 mm}
sensors:
  tip: {type: marker, body: arm, point: 0 0 -60 mm, delay: 5 ms}
controllers:
  follow: {type: closed-loop, effectors: {tip: {target: 0.815649 0.0150398 -59.8814 mm}}, sensors: [tip], actuators: [twist],
           gain: 10 1/s, integral: 4 1/s^2}
"""


def test_friction_of_joints_is_held_where_the_response_is_taken(tmp_path):
    """Regression: the response used the friction of another state in a clone than in the run."""
    path = tmp_path / "scene.yaml"
    path.write_text(JOINT_THAT_RUBS)
    sim = sinew.load(path)
    sim.step(3)
    copy = sim.clone()
    for _ in range(3):
        sim.step()
        copy.step()
        assert sim.state_hash == copy.state_hash
