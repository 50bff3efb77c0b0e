"""What every actuator has, whatever its type: effort, motion, their names and units, and how it is told."""

import pytest

import sinew

SCENE = """sinew: 1
time_step: 10 ms
bodies:
  block:
    type: fem
    mesh: {shape: hollow-cylinder, inner_radius: 5 mm, outer_radius: 10 mm, height: 40 mm, element_size: 8 mm}
    material: {model: neo-hookean, shear_modulus: 40 kPa, poisson_ratio: 0.45}
    density: 1000 kg/m^3
    fixed: {set: bottom}
  arm: {type: pcc, pose: {position: 60 0 0 mm}, segments: [{length: 50 mm, mass: 10 g, stiffness: 0.02 N m}]}
  wheel: {type: rigid, shape: {box: 10 10 10 mm}, mass: 10 g, pose: {position: 0 80 0 mm}}
joints:
  axle: {type: hinge, bodies: [world, wheel], point: 0 80 0 mm, axis: z}
actuators:
  rope: {type: cable, body: block, points: [7 0 2 mm, 7 0 38 mm], guide_radius: 1 mm}
  push: {type: force, body: block, point: 0 8 40 mm, direction: 1 0 0, outside: nearest}
  air: {type: chamber, body: block, surface: {set: inner}, cap: true}
  band: {type: spring, body: block, points: [0 7 2 mm, 0 7 38 mm], stiffness: 10 N/m}
  bend: {type: torque, body: arm, segment: 0}
  turn: {type: motor, joint: axle, command: {angle: 0 deg}}
"""
NAMES = {"rope": ("tension", "N", "displacement", "m"), "push": ("force", "N", "displacement", "m"),
         "air": ("pressure", "Pa", "volume_growth", "m^3"), "band": ("tension", "N", "displacement", "m"),
         "bend": ("torque", "N m", "angle", "rad"), "turn": ("torque", "N m", "angle", "rad")}


@pytest.fixture(scope="module")
def sim():
    return sinew.loads(SCENE)


def test_names_and_units(sim):
    assert list(sim.actuators) == list(NAMES)
    for name, (effort, unit, motion, motion_unit) in NAMES.items():
        assert list(sim.actuator(name).quantities.items()) == [(effort, unit), (motion, motion_unit)]


def test_effort_and_motion_are_the_quantities(sim):
    for name, told in (("rope", 0.2), ("push", 0.05), ("air", 500.0), ("bend", 1e-3)):
        sim.actuator(name).effort = told
    sim.solve_static()
    for name, (effort, _, motion, _) in NAMES.items():
        actuator = sim.actuator(name)
        assert actuator.effort == getattr(actuator, effort) and actuator.motion == getattr(actuator, motion)
    assert sim.actuator("air").effort == 500.0 and sim.actuator("air").motion > 0.0
    assert sim.actuator("push").command == ("force", 0.05)
    sim.actuator("bend").motion = 0.1
    sim.solve_static()
    assert sim.actuator("bend").angle == pytest.approx(0.1) and sim.actuator("bend").command == ("angle", 0.1)
    sim.reset()


def test_how_it_is_told(sim):
    assert [name for name in NAMES if sim.actuator(name).pulls_only] == ["rope"]
    assert [name for name in NAMES if sim.actuator(name).regulates_effort] == ["air"]
    assert [name for name in NAMES if not sim.actuator(name).controllable] == ["band"]
    with pytest.raises(sinew.Error, match="a cable can only pull"):
        sim.actuator("rope").effort = -1.0
    with pytest.raises(sinew.Error) as caught:
        sim.actuator("band").effort = 1.0
    assert caught.value.kind == "wrong-actuator-type"
