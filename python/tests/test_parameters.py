"""The named numbers on which motion depends: Simulation.parameters()."""

import math

import pytest

import sinew

SCENE = """sinew: 1
time_step: 5 ms
integrator: bdf2
gravity: 0 0 -9.81
bodies:
  finger:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 12 mm, height: 12 mm, element_size: 6 mm}
    material: {model: corotational, young_modulus: 300 kPa, poisson_ratio: 0.4}
    density: 1100 kg/m^3
    damping: {mass: 0.4 1/s, stiffness: 2 ms}
    parts:
      tip:
        region: {box: 41 -1 -1 61 13 13 mm}
        material: {model: neo-hookean, young_modulus: 150 kPa, poisson_ratio: 0.45}
        density: 900 kg/m^3
    fixed: {set: x_min}
  ball:
    type: rigid
    shape: {sphere: {radius: 8 mm}}
    pose: {position: 50 6 30 mm}
    mass: 20 g
  arm:
    type: pcc
    pose: {position: 0 200 0 mm}
    segments: [{length: 80 mm, mass: 60 g, stiffness: 0.05 N m, damping: 0.002 N m s}]
membranes:
  skin: {body: finger, surface: {set: z_min}, thickness: 0.2 mm, young_modulus: 1 MPa, poisson_ratio: 0.25}
masses:
  marker: {body: finger, point: 60 6 6 mm, mass: 2 g}
actuators:
  cable:
    type: cable
    body: finger
    points: [0 6 10 mm, 30 6 10 mm, 58 6 10 mm]
    friction: 0.1
    limits: {tension: {max: 8 N, rate: 40 N/s}, displacement: {max: 9 mm}}
    command: {tension: 0.5 N}
  band: {type: spring, body: finger, points: [0 2 2 mm, 58 2 2 mm], stiffness: 30 N/m, free_length: 55 mm, damping: 0.3 N s/m}
loads:
  wind: {type: force, body: finger, point: 60 6 6 mm, force: 0 0.01 0 N, factor: 0.5}
contacts:
  touch: {between: [finger, ball], friction: 0.4}
"""


def parameters(*overrides):
    return sinew.loads(SCENE, set=list(overrides)).parameters()


# Paths that are the scene's, with another value for each.
STATED = {
    "time_step": ("4 ms", 4e-3, "s"),
    "bodies.finger.material.young_modulus": ("310 kPa", 310e3, "Pa"),
    "bodies.finger.material.poisson_ratio": ("0.41", 0.41, ""),
    "bodies.finger.density": ("1150 kg/m^3", 1150.0, "kg/m^3"),
    "bodies.finger.damping.mass": ("0.5 1/s", 0.5, "1/s"),
    "bodies.finger.damping.stiffness": ("3 ms", 3e-3, "s"),
    "bodies.finger.parts.tip.density": ("950 kg/m^3", 950.0, "kg/m^3"),
    "bodies.ball.mass": ("25 g", 0.025, "kg"),
    "membranes.skin.thickness": ("0.3 mm", 3e-4, "m"),
    "membranes.skin.young_modulus": ("1.2 MPa", 1.2e6, "Pa"),
    "membranes.skin.poisson_ratio": ("0.3", 0.3, ""),
    "masses.marker.mass": ("3 g", 3e-3, "kg"),
    "actuators.cable.friction": ("0.2", 0.2, ""),
    "actuators.cable.limits.tension.max": ("9 N", 9.0, "N"),
    "actuators.cable.limits.tension.rate": ("50 N/s", 50.0, "N/s"),
    "actuators.cable.limits.displacement.max": ("8 mm", 8e-3, "m"),
    "actuators.cable.command.tension": ("0.6 N", 0.6, "N"),
    "actuators.band.stiffness": ("35 N/m", 35.0, "N/m"),
    "actuators.band.free_length": ("54 mm", 54e-3, "m"),
    "actuators.band.damping": ("0.4 N s/m", 0.4, "N s/m"),
    "loads.wind.factor": ("0.7", 0.7, ""),
    "contacts.touch.friction": ("0.5", 0.5, ""),
}


@pytest.fixture(scope="module")
def before():
    return parameters()


@pytest.mark.parametrize("path", STATED)
def test_a_value_of_the_scene_is_one_parameter(before, path):
    text, value, unit = STATED[path]
    after = parameters(f"{path}={text}")
    assert list(after) == list(before)
    assert after[path].value == pytest.approx(value, rel=1e-12)
    assert after[path].unit == unit
    changed = [one for one in before if after[one].value != before[one].value]
    assert changed == [path]


def test_values_are_those_of_the_scene(before):
    assert before["bodies.finger.material.young_modulus"].value == 300e3
    assert before["bodies.finger.gravity.z"].value == -9.81
    assert before["bodies.arm.segments.0.stiffness"].value == pytest.approx(0.05)
    assert before["bodies.arm.segments.0.stiffness"].unit == "N m"
    assert before["bodies.finger.stiffness_factor"].value == 1.0
    assert all(math.isfinite(one.value) for one in before.values())
    assert all(path == one.path for path, one in before.items())
    assert "actuators.band.friction" not in before
    assert not [path for path in before if path.startswith("actuators.band.command")]
    assert repr(before["time_step"]) == "<sinew.Parameter time_step = 0.005 s>"


def test_inputs_can_be_set():
    sim = sinew.loads(SCENE)
    sim.set_parameter("bodies.finger.stiffness_factor", 2.0)
    sim.set_parameter("actuators.cable.command.tension", 1.5)
    sim.set_parameter("loads.wind.factor", -1.0)
    assert sim.bodies["finger"].stiffness_factor == 2.0
    now = sim.parameters()
    assert now["actuators.cable.command.tension"].value == 1.5
    assert now["loads.wind.factor"].value == -1.0
    for _ in range(10):
        sim.step()
    assert sim.actuators["cable"].tension == pytest.approx(1.5)  # reached at 40 N/s


def test_the_model_cannot_be_set():
    sim = sinew.loads(SCENE)
    with pytest.raises(sinew.Error, match="belongs to the model") as caught:
        sim.set_parameter("bodies.finger.material.young_modulus", 1e5)
    assert caught.value.kind == "bad-argument"
    with pytest.raises(sinew.Error, match="did you mean 'bodies.finger.stiffness_factor'") as caught:
        sim.set_parameter("bodies.finger.stiffness_facto", 1.0)
    assert caught.value.kind == "unknown-name"


def test_a_command_that_varies_is_no_number():
    sim = sinew.loads(SCENE, set=["actuators.cable.command={tension: {sine: {mean: 1 N, amplitude: 1 N, period: 1 s}}}"])
    assert "actuators.cable.command.tension" not in sim.parameters()
    assert "actuators.cable.friction" in sim.parameters()
